//! What `measure` prints with `--json` and `merge` reads.

use serde::{Deserialize, Serialize};
use solidray::Aabb;
use solidray::measure::{
    self, Body, Mass, Missed, Properties, Quantity, Replicate, Run, Sampling,
};

use super::super::output::{BoundsJson, bounds_json};
use super::super::pieces::By;

#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct Report {
    pub(super) file: String,
    /// What the parts are; reports from before there were objects have parts.
    #[serde(default)]
    pub(super) by: By,
    /// The whole solid; what parts share counts once.
    pub(super) whole: PartJson,
    /// The parts, if there are several.
    pub(super) parts: Vec<PartJson>,
    /// Of all parts together, if densities were given.
    pub(super) mass: Option<MassJson>,
    pub(super) rel_tol: f64,
    pub(super) abs_tol: f64,
    pub(super) seconds: f64,
    pub(super) interrupted: bool,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct PartJson {
    pub(super) name: Option<String>,
    pub(super) density: Option<f64>,
    #[serde(default)]
    pub(super) properties: Option<PropertiesJson>,
    /// All that it takes to combine it with other runs.
    pub(super) runs: Vec<RunJson>,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct PropertiesJson {
    pub(super) volume: QuantityJson,
    pub(super) area: QuantityJson,
    pub(super) body: Option<BodyJson>,
    /// Null where nothing was met.
    pub(super) reached: Option<BoundsJson>,
    /// Null where there is nothing.
    pub(super) bounds: Option<BoundsJson>,
    pub(super) method: String,
    pub(super) rays: u64,
    pub(super) resolved: bool,
    pub(super) target_met: bool,
    pub(super) spans: u64,
    pub(super) uncertain: u64,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct BodyJson {
    pub(super) centroid: [QuantityJson; 3],
    pub(super) inertia: [[QuantityJson; 3]; 3],
    pub(super) principal: [PrincipalJson; 3],
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct PrincipalJson {
    pub(super) moment: QuantityJson,
    pub(super) axis: [f64; 3],
    /// In radians.
    pub(super) angle: f64,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct MassJson {
    pub(super) mass: QuantityJson,
    pub(super) body: Option<BodyJson>,
}

/// Bounds that are not finite are null.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(super) struct QuantityJson {
    pub(super) value: f64,
    pub(super) interval: [Option<f64>; 2],
    pub(super) target_met: bool,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct RunJson {
    seed: u64,
    bounds: Option<BoundsJson>,
    lattice: u64,
    rays: u64,
    reached: Option<BoundsJson>,
    /// Volume and area that there may be more; none in reports from before it was known.
    #[serde(default)]
    missed: MissedJson,
    replicates: Vec<ReplicateJson>,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
struct MissedJson {
    volume: f64,
    area: f64,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
struct ReplicateJson {
    integrals: [f64; 11],
    hits: u64,
    spans: u64,
    uncertain: u64,
}

impl Report {
    /// Finds all numbers from the runs.
    pub(super) fn sum_up(&mut self) -> anyhow::Result<()> {
        let sampling = Sampling {
            rel_tol: self.rel_tol,
            abs_tol: self.abs_tol,
            ..Sampling::default()
        };
        for part in std::iter::once(&mut self.whole).chain(&mut self.parts) {
            let found = measure::merge(&part.measured(), &sampling)?;
            part.properties = Some((&found).into());
        }
        let parts = match &self.parts[..] {
            [] => std::slice::from_ref(&self.whole),
            parts => parts,
        };
        let runs: Option<Vec<(f64, Vec<Run>)>> =
            parts.iter().map(|part| Some((part.density?, part.measured()))).collect();
        if let Some(runs) = runs {
            let all: Vec<(f64, &[Run])> =
                runs.iter().map(|(d, r)| (*d, &r[..])).collect();
            self.mass = Some((&measure::mass(&all, &sampling)?).into());
        }
        Ok(())
    }

    pub(super) fn target_met(&self) -> bool {
        let all = std::iter::once(&self.whole).chain(&self.parts);
        all.filter_map(|part| part.properties.as_ref()).all(|found| found.target_met)
    }
}

impl PartJson {
    pub(super) fn new(name: Option<&str>, density: Option<f64>, runs: &[Run]) -> Self {
        let runs = runs.iter().map(RunJson::from).collect();
        Self { name: name.map(str::to_owned), density, properties: None, runs }
    }

    fn measured(&self) -> Vec<Run> {
        self.runs.iter().map(Run::from).collect()
    }
}

impl From<&Properties> for PropertiesJson {
    fn from(found: &Properties) -> Self {
        Self {
            volume: found.volume.into(),
            area: found.area.into(),
            body: found.body.as_ref().map(BodyJson::from),
            reached: bounds_json(&found.reached),
            bounds: bounds_json(&found.bounds),
            method: found.method.name().to_owned(),
            rays: found.rays,
            resolved: found.resolved,
            target_met: found.target_met(),
            spans: found.spans,
            uncertain: found.uncertain,
        }
    }
}

impl From<&Body> for BodyJson {
    fn from(body: &Body) -> Self {
        Self {
            centroid: body.centroid.map(QuantityJson::from),
            inertia: body.inertia.map(|row| row.map(QuantityJson::from)),
            principal: body.principal.map(|found| PrincipalJson {
                moment: found.moment.into(),
                axis: found.axis.to_array(),
                angle: found.angle,
            }),
        }
    }
}

impl From<&Mass> for MassJson {
    fn from(found: &Mass) -> Self {
        Self { mass: found.mass.into(), body: found.body.as_ref().map(BodyJson::from) }
    }
}

impl From<Quantity> for QuantityJson {
    fn from(quantity: Quantity) -> Self {
        Self {
            value: quantity.value,
            interval: quantity.interval.map(|x| x.is_finite().then_some(x)),
            target_met: quantity.target_met(),
        }
    }
}

impl QuantityJson {
    /// Half the width of the interval, if it has ends.
    pub(super) fn half_width(&self) -> Option<f64> {
        let [low, high] = self.interval;
        Some(0.5 * (high? - low?))
    }
}

impl From<&Run> for RunJson {
    fn from(run: &Run) -> Self {
        let replicate = |found: &Replicate| {
            let Replicate { integrals, hits, spans, uncertain } = *found;
            ReplicateJson { integrals, hits, spans, uncertain }
        };
        let Missed { volume, area } = run.missed;
        Self {
            seed: run.seed,
            bounds: bounds_json(&run.bounds),
            lattice: run.lattice,
            rays: run.rays,
            reached: bounds_json(&run.reached),
            missed: MissedJson { volume, area },
            replicates: run.replicates.iter().map(replicate).collect(),
        }
    }
}

impl From<&RunJson> for Run {
    fn from(run: &RunJson) -> Self {
        let bounds = |bounds: Option<BoundsJson>| {
            bounds.map_or(Aabb::EMPTY, |b| Aabb::new(b.min.into(), b.max.into()))
        };
        let replicate = |found: &ReplicateJson| {
            let ReplicateJson { integrals, hits, spans, uncertain } = *found;
            Replicate { integrals, hits, spans, uncertain }
        };
        let MissedJson { volume, area } = run.missed;
        Self {
            seed: run.seed,
            bounds: bounds(run.bounds),
            lattice: run.lattice,
            rays: run.rays,
            replicates: run.replicates.iter().map(replicate).collect(),
            reached: bounds(run.reached),
            missed: Missed { volume, area },
        }
    }
}
