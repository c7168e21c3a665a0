//! What is said of a mesh that was written.

use glam::DVec3;
use serde::Serialize;
use solidray::measure::Apart;

use super::super::Global;
use super::super::output::{EstimateJson, earned, in_words};
use super::super::pieces::{hex, label};
use super::{Looked, Object, Seconds};

/// A file, and what is known of it.
pub(super) struct Written {
    pub(super) output: String,
    pub(super) bytes: usize,
    pub(super) tolerance: f64,
    pub(super) objects: Vec<Object>,
    pub(super) seconds: Seconds,
}

#[derive(Serialize)]
pub(super) struct Report<'a> {
    output: &'a str,
    bytes: usize,
    triangles: usize,
    points: usize,
    tolerance: f64,
    /// These are `null` if nobody looked.
    largest_found: Option<f64>,
    within_tolerance: Option<bool>,
    objects: Vec<ObjectJson<'a>>,
    seconds: Seconds,
}

#[derive(Serialize)]
struct ObjectJson<'a> {
    name: Option<&'a str>,
    color: Option<String>,
    triangles: usize,
    points: usize,
    volume: f64,
    /// The rest is `null` if nobody looked.
    solid_volume: Option<EstimateJson>,
    from_mesh: Option<ApartJson>,
    from_solid: Option<ApartJson>,
}

#[derive(Serialize)]
struct ApartJson {
    largest_found: f64,
    at: Option<[f64; 3]>,
    to: Option<[f64; 3]>,
    points: u64,
    lost: u64,
    thin: u64,
    lines: u64,
}

impl From<&Apart> for ApartJson {
    fn from(apart: &Apart) -> Self {
        let Apart { largest, ends, points, lost, thin, lines } = *apart;
        let [at, to] = [0, 1].map(|i| ends.map(|ends| ends[i].to_array()));
        Self { largest_found: largest, at, to, points, lost, thin, lines }
    }
}

impl<'a> From<&'a Object> for ObjectJson<'a> {
    fn from(object: &'a Object) -> Self {
        let Object { part, mesh, looked } = object;
        let looked = looked.as_ref();
        Self {
            name: part.name.as_deref(),
            color: part.color.map(hex),
            triangles: mesh.faces().len(),
            points: mesh.points().len(),
            volume: mesh.volume(),
            solid_volume: looked.map(|looked| EstimateJson::from(&looked.volume)),
            from_mesh: looked.map(|looked| ApartJson::from(&looked.from_mesh)),
            from_solid: looked.map(|looked| ApartJson::from(&looked.from_solid)),
        }
    }
}

impl Written {
    /// Whether nothing was found that is farther away than the tolerance, if anybody looked.
    pub(super) fn is_within(&self) -> Option<bool> {
        let mut looked = self.objects.iter().map(|object| object.looked.as_ref());
        looked
            .try_fold(true, |all, looked| Some(all && looked?.is_within(self.tolerance)))
    }

    /// Triangles and points of all objects.
    fn counts(&self) -> [usize; 2] {
        self.objects.iter().fold([0, 0], |[triangles, points], Object { mesh, .. }| {
            [triangles + mesh.faces().len(), points + mesh.points().len()]
        })
    }

    /// The report as an object.
    pub(super) fn report(&self) -> Report<'_> {
        let [triangles, points] = self.counts();
        let looked = self.objects.iter().filter_map(|object| object.looked.as_ref());
        Report {
            output: &self.output,
            bytes: self.bytes,
            triangles,
            points,
            tolerance: self.tolerance,
            largest_found: looked.map(Looked::largest).reduce(f64::max),
            within_tolerance: self.is_within(),
            objects: self.objects.iter().map(ObjectJson::from).collect(),
            seconds: self.seconds,
        }
    }

    /// The report in words.
    pub(super) fn lines(&self, global: Global) -> Vec<String> {
        let [triangles, points] = self.counts();
        let mut lines = vec![
            format!("triangles  {triangles} with {points} points, {} bytes", self.bytes),
            format!("tolerance  {:.3e}", self.tolerance),
        ];
        for object in &self.objects {
            if self.objects.len() > 1 {
                let (name, triangles) = (label(&object.part), object.mesh.faces().len());
                lines.push(format!("object     {name}, {triangles} triangles"));
            }
            object.describe(self.tolerance, &mut lines);
        }
        if global.verbose {
            let Seconds { read, compile, mesh, look, write } = self.seconds;
            lines.push(format!(
                "seconds    reading {read:.3}, compiling {compile:.3}, mesh {mesh:.3}, looking {look:.3}, writing {write:.3}"
            ));
        }
        lines
    }
}

impl Object {
    fn describe(&self, tolerance: f64, lines: &mut Vec<String>) {
        let volume = self.mesh.volume();
        let Some(looked) = &self.looked else {
            lines.push(format!("volume     {volume} of the mesh"));
            return;
        };
        let ways =
            [(&looked.from_mesh, "mesh", "solid"), (&looked.from_solid, "solid", "mesh")];
        for (apart, from, to) in ways {
            let Apart { largest, ends, points, lost, thin, .. } = apart;
            let place = |[from, _]: [DVec3; 2]| format!(", at {}", near(from, tolerance));
            lines.push(format!(
                "distance   {largest:.3e} from the {from} to the {to}: the largest found at {points} points{}",
                ends.map(place).unwrap_or_default()
            ));
            if *lost > 0 {
                lines.push(format!(
                    "           from {lost} of the points no ray met the {to}"
                ));
            }
            if *thin > 0 {
                lines.push(format!(
                    "           {thin} points more are on walls and gaps too thin to look at"
                ));
            }
        }
        let of_solid = in_words(&looked.volume);
        let volume = earned(volume, looked.volume.half_width());
        lines.push(format!("volume     {volume} of the mesh, {of_solid} of the solid"));
        if !looked.has_points() {
            let hint =
                "           too thin for this tolerance: a smaller one looks closer";
            lines.push(hint.to_owned());
        } else if !looked.is_within(tolerance) {
            lines.push("           farther than the tolerance".to_owned());
        }
    }
}

/// A point as `x,y,z`, to the digits that matter beside a tolerance.
fn near(p: DVec3, tolerance: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "between 0 and 300")]
    #[expect(clippy::cast_sign_loss, reason = "between 0 and 300")]
    let decimals = (2.0 - tolerance.log10().floor()).clamp(0.0, 300.0) as usize;
    let DVec3 { x, y, z } = p;
    format!("{x:.decimals$},{y:.decimals$},{z:.decimals$}")
}
