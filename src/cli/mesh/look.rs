//! How far a mesh is from the solid that it stands for.

use solidray::measure::{self, Apart, Estimate, Sampling, Search};
use solidray::{CompileOptions, Scene, Solid};

use super::super::Global;
use super::super::meter::Meter;

/// The most rays for the volume of the solid, in multiples of the lines.
const VOLUME_RAYS: u64 = 16;

/// How rays look.
pub(super) struct Look {
    pub(super) lines: u64,
    pub(super) seed: u64,
    /// Walls and gaps that are thinner are not looked at.
    pub(super) thinnest: f64,
    pub(super) compiling: CompileOptions,
    pub(super) global: Global,
}

/// What rays found.
pub(super) struct Looked {
    pub(super) from_mesh: Apart,
    pub(super) from_solid: Apart,
    /// The volume of the solid.
    pub(super) volume: Estimate,
}

impl Look {
    pub(super) fn at(
        &self,
        solid: &Scene,
        mesh: &solidray::Mesh,
    ) -> anyhow::Result<Looked> {
        let mesh = Scene::compile_with(&Solid::mesh(mesh.clone()), &self.compiling)?;
        let meter = Meter::new(self.global, "looking", None);
        let watch = |rays| meter.step(rays);
        let Self { lines, seed, thinnest, .. } = *self;
        let search = Search { lines, seed, thinnest };
        let from_mesh = measure::apart(&mesh, solid, &search, &watch);
        let from_solid = measure::apart(solid, &mesh, &search, &watch);
        // Thin solids would take all the rays there are for a few digits.
        let max_rays = VOLUME_RAYS * lines;
        let sampling = Sampling { seed, max_rays, ..Sampling::default() };
        let volume = measure::volume_with(solid, &sampling, &watch);
        Ok(Looked { from_mesh, from_solid, volume })
    }
}

impl Looked {
    /// The largest distance either way.
    pub(super) fn largest(&self) -> f64 {
        self.from_mesh.largest.max(self.from_solid.largest)
    }

    /// Whether there are points to look from on both.
    pub(super) fn has_points(&self) -> bool {
        self.from_mesh.points > 0 && self.from_solid.points > 0
    }

    /// Whether nothing was found that is farther away, of something.
    pub(super) fn is_within(&self, tolerance: f64) -> bool {
        let lost = self.from_mesh.lost + self.from_solid.lost;
        self.has_points() && self.largest() <= tolerance && lost == 0
    }
}
