//! `hull` and `minkowski`.
//!
//! Hulls of circles, of balls and of plates are exact. There is no exact solid for most of the others:
//! their true curves become fine polyhedra first.

use super::super::error::{Located, ReadErrorKind};
use super::super::hull;
use super::super::options::Curves;
use super::super::outline::{self, Outline, Paths};
use super::arguments::Call;
use super::combine::{Alike, quoted};
use super::curve;
use super::evaluate::Reading;
use super::node::Shape;
use crate::facets::{self, FacetsError, Fine, Operand};
use crate::mesh::Mesh;
use crate::op::Op;
use crate::solid::{Kind, Solid, Tag};

/// The convex hull of all children. Within another hull these do as they are.
pub(super) fn hull(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let alike = Alike::new(children, &quoted(call), call.place(), reading);
    if reading.is_hulled && reading.options.curves != Curves::Faceted {
        return Ok(alike.joined(Op::Union));
    }
    match alike {
        Alike::Flat(outlines) => {
            if !reading.is_faceted
                && let Some(hull) = outline::exact_hull(&outlines)
            {
                return Ok(Shape::Flat(hull.tagged(Tag::Place(call.place()))));
            }
            let paths = outlines.iter().flat_map(|o| polygons(o, reading));
            let points = paths.flatten().collect::<Vec<_>>();
            Ok(flat(vec![outline::hull(points)], call))
        }
        Alike::Solid(mut solids) => {
            if let [solid] = &solids[..]
                && is_convex(solid)
            {
                return Ok(solids.pop().map_or(Shape::Empty, Shape::Solid));
            }
            let all = Solid::boolean(Op::Union, solids);
            if !reading.is_faceted
                && let Some(hull) = exact_hull(&all, call, reading)?
            {
                return Ok(Shape::Solid(hull.placed(call.place()).as_outline()));
            }
            let parts = parts(&all, call, reading)?;
            let corners = |mesh: &Mesh| mesh.points().to_vec();
            let points: Vec<_> = parts.iter().flat_map(corners).collect();
            let hull = facets::hull(&points).map_err(|e| fault(call, e))?;
            solid(hull.into_iter().collect(), call, reading)
        }
    }
}

/// The hull of solids that have an exact one.
fn exact_hull(
    solid: &Solid,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Option<Solid>, Located> {
    let hull = fine(reading, |fine| hull::exact(solid, fine));
    let hull = hull.map_err(|e| fault(call, e))?;
    let (mut triangles, mut open) = (0, Vec::from_iter(&hull));
    while let Some(solid) = open.pop() {
        if let Kind::Mesh(mesh) = solid.kind() {
            triangles += mesh.faces().len() as u64;
        }
        open.extend(solid.children());
    }
    reading.count_facets(triangles, call.place())?;
    Ok(hull)
}

/// The sum of all children: the points that are sums of a point of each.
pub(super) fn minkowski(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    match Alike::new(children, &quoted(call), call.place(), reading) {
        Alike::Flat(mut outlines) if outlines.len() < 2 => {
            Ok(outlines.pop().map_or(Shape::Empty, Shape::Flat))
        }
        Alike::Solid(mut solids) if solids.len() < 2 => {
            Ok(solids.pop().map_or(Shape::Empty, Shape::Solid))
        }
        Alike::Flat(outlines) => {
            let mut all = outlines.iter().map(|o| polygons(o, reading));
            let mut sum = all.next().unwrap_or_default();
            for other in all {
                let corners = |p: &Paths| p.iter().map(|path| path.len() as u64).sum();
                let count = u64::saturating_mul(corners(&sum), corners(&other));
                allow(4 * count, call, reading)?;
                sum = match sum.is_empty() || other.is_empty() {
                    true => Vec::new(),
                    false => outline::sum(&sum, &other),
                };
            }
            Ok(flat(sum, call))
        }
        Alike::Solid(solids) => {
            let mut sum: Option<Vec<Mesh>> = None;
            for child in &solids {
                let parts = parts(child, call, reading)?;
                sum = Some(match sum {
                    None => parts,
                    Some(before) => sum_of_unions(before, parts, call, reading)?,
                });
            }
            solid(sum.unwrap_or_default(), call, reading)
        }
    }
}

/// The sums of all pairs of meshes.
fn sum_of_unions(
    a: Vec<Mesh>,
    b: Vec<Mesh>,
    call: &Call<'_>,
    reading: &Reading<'_>,
) -> Result<Vec<Mesh>, Located> {
    let operands = |meshes: Vec<Mesh>| {
        let made = meshes.into_iter().map(Operand::new).collect::<Result<Vec<_>, _>>();
        made.map_err(|e| fault(call, e))
    };
    let (a, b) = (operands(a)?, operands(b)?);
    let pairs = || a.iter().flat_map(|p| b.iter().map(move |q| (p, q)));
    let counts = pairs().map(|(p, q)| facets::triangles_of_sum(p, q));
    allow(counts.fold(0, u64::saturating_add), call, reading)?;
    let mut sums = Vec::new();
    for (p, q) in pairs() {
        sums.extend(facets::sum(p, q).map_err(|e| fault(call, e))?);
    }
    Ok(sums)
}

/// Refuses what would take too many triangles on the way.
fn allow(count: u64, call: &Call<'_>, reading: &Reading<'_>) -> Result<(), Located> {
    let limit = reading.options.max_facets;
    if count > limit {
        let kind = ReadErrorKind::TooManyFacets { count, limit };
        return Err(Located::at(call.place(), kind));
    }
    Ok(())
}

/// Meshes whose union is a solid.
pub(super) fn parts(
    solid: &Solid,
    call: &Call<'_>,
    reading: &Reading<'_>,
) -> Result<Vec<Mesh>, Located> {
    fine(reading, |fine| facets::parts(solid, fine)).map_err(|e| fault(call, e))
}

/// What is done with the fineness that the options ask for.
pub(super) fn fine<T>(reading: &Reading<'_>, make: impl FnOnce(&Fine<'_>) -> T) -> T {
    /// Hulls of polyhedra with the volume of balls are larger than those of the balls, by a third
    /// of the square of half a segment's angle at most: 6 in 10,000.
    const FEWEST: u32 = 72;
    // A quarter of the distance are twice the segments.
    let tolerance = 0.25 * reading.options.facet_tolerance;
    let segments = |radius: f64| curve::fine(radius, tolerance, reading).max(FEWEST);
    let most_triangles = reading.options.max_facets;
    make(&Fine { circle: &segments, ball: &segments, most_triangles })
}

/// The polygons of an outline.
pub(super) fn polygons(outline: &Outline, reading: &Reading<'_>) -> Paths {
    fine(reading, |fine| outline.polygons(fine.circle))
}

pub(super) fn fault(call: &Call<'_>, error: FacetsError) -> Located {
    let kind = match error {
        FacetsError::TooMany { count, limit } => {
            ReadErrorKind::TooManyFacets { count, limit }
        }
        FacetsError::Mesh(error) => ReadErrorKind::Mesh(error),
        error @ (FacetsError::NoFacets(_)
        | FacetsError::BadParameter { .. }
        | FacetsError::TooFewSegments(_)
        | FacetsError::BadTolerance(_)
        | FacetsError::Unbounded
        | FacetsError::NotTaken(_)
        | FacetsError::Stopped) => ReadErrorKind::Facets(error),
    };
    Located::at(call.place(), kind)
}

/// Simple polygons as a shape.
pub(super) fn flat(mut paths: Paths, call: &Call<'_>) -> Shape {
    paths.retain(|path| path.len() > 2);
    if paths.is_empty() {
        return Shape::Empty;
    }
    Shape::Flat(Outline::paths(paths).tagged(Tag::Place(call.place())))
}

/// The union of meshes as a shape.
fn solid(
    mut meshes: Vec<Mesh>,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let triangles = meshes.iter().map(|mesh| mesh.faces().len() as u64).sum();
    reading.count_facets(triangles, call.place())?;
    let solid = match meshes.len() {
        0 => return Ok(Shape::Empty),
        1 => Solid::mesh(meshes.swap_remove(0)),
        _ => Solid::boolean(Op::Union, meshes.into_iter().map(Solid::mesh)),
    };
    Ok(Shape::Solid(solid.placed(call.place()).as_outline()))
}

/// Whether a solid is a single convex primitive.
fn is_convex(mut solid: &Solid) -> bool {
    loop {
        match (solid.kind(), solid.children()) {
            (Kind::Primitive(primitive), _) => {
                return primitive.describe().is_convex();
            }
            (Kind::Mesh(_), _) => return false,
            (_, [only]) => solid = only,
            (_, _) => return false,
        }
    }
}
