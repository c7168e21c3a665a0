//! `polyhedron`.

use glam::DVec3;

use super::super::error::{Located, ReadErrorKind};
use super::super::faces::{Faces, TURNED};
use super::arguments::Call;
use super::evaluate::Reading;
use super::node::Shape;
use crate::facets;
use crate::solid::Solid;

/// Points that are nearer to each other are one to OpenSCAD.
const GRID: f64 = 1.0 / (1_u32 << 20) as f64;

/// Points, and faces clockwise seen from outside. Faces that bound no solid are left out with a
/// warning; they are an error if nothing else is left.
pub(super) fn polyhedron(
    call: &Call<'_>,
    _: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let mut read = Faces::default();
    for value in call.vector("points")?.unwrap_or_default() {
        let point = call.document.numbers(value).map(DVec3::from_array);
        let point = point.filter(|p| p.is_finite());
        read.points.push(
            point.ok_or_else(|| {
                call.wrong("points", "triples of finite numbers", value)
            })?,
        );
    }
    let (mut dropped, mut corners) = (0, Vec::new());
    let parameter = if call.value("faces").is_some() { "faces" } else { "triangles" };
    for value in call.vector(parameter)?.unwrap_or_default() {
        let (mut face, others) = chosen(call, parameter, value, read.points.len())?;
        dropped += others;
        // OpenSCAD's faces are clockwise, ours counter-clockwise.
        face.reverse();
        if reading.is_hulled {
            corners.extend(face.iter().map(|&i| read.points[i as usize]));
        }
        if face.len() > 2 {
            read.push(face);
        }
    }
    warn_of_dropped(call, dropped, reading);
    if read.is_empty() {
        return Ok(Shape::Empty);
    }
    let place = call.place();
    let built = match read.build_on_grid(Some(GRID)) {
        Ok(built) => built,
        // Corners have a hull whether they are those of a solid or not.
        Err(_) if reading.is_hulled => {
            let hull = facets::hull(&corners);
            let hull = hull.map_err(|e| Located::at(place, ReadErrorKind::Facets(e)))?;
            return Ok(hull.map_or(Shape::Empty, |mesh| {
                Shape::Solid(Solid::mesh(mesh).placed(place))
            }));
        }
        Err(error) => {
            reading.leave_out(Located::at(place, error.kind), place);
            return Ok(Shape::Empty);
        }
    };
    if built.turned {
        reading.model.counts.turned += 1;
        reading.warn(place, TURNED);
    }
    Ok(Shape::Solid(Solid::mesh(built.mesh).placed(place)))
}

/// The indices in a list that name points, and how many others it has, which OpenSCAD
/// leaves out.
pub(super) fn chosen(
    call: &Call<'_>,
    parameter: &str,
    list: u32,
    points: usize,
) -> Result<(Vec<u32>, usize), Located> {
    let (mut chosen, mut dropped) = (Vec::new(), 0);
    for value in call.elements(parameter, list)? {
        let expected = "lists of the numbers of points";
        let number = call.document.number(value);
        let number = number.ok_or_else(|| call.wrong(parameter, expected, value))?;
        match index(number, points) {
            Some(index) => chosen.push(index),
            None => dropped += 1,
        }
    }
    Ok((chosen, dropped))
}

/// Warns of indices that name no point.
pub(super) fn warn_of_dropped(
    call: &Call<'_>,
    dropped: usize,
    reading: &mut Reading<'_>,
) {
    if dropped > 0 {
        let name = call.name();
        let message = format!(
            "`{name}` names points that do not exist {dropped} times; they are left out"
        );
        reading.warn(call.place(), message);
    }
}

/// A number as an index of so many points; fractions are cut off.
fn index(number: f64, points: usize) -> Option<u32> {
    let limit = u32::try_from(points).unwrap_or(u32::MAX);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the range is checked in the same line"
    )]
    (number > -1.0 && number < f64::from(limit)).then_some(number as u32)
}
