//! The error of volumes against their cost.

use std::time::Instant;

use serde::Serialize;
use solidray::facets::{self, FacetsError};
use solidray::measure::{self, Estimate, Method, Sampling};
use solidray::unwatched;

use super::super::interrupt::interrupted;
use super::fit::order;
use super::ladder::{Outcome, Rung, climb};
use super::{Series, Study, on_one_thread};

/// The volumes that the methods found, beside the best there is.
#[derive(Serialize)]
pub(super) struct Volumes {
    pub(super) reference: Reference,
    pub(super) series: Vec<Series>,
}

/// The best volume there is.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Reference {
    pub(super) value: f64,
    pub(super) half_width: f64,
    pub(super) method: &'static str,
}

impl Reference {
    fn error_of(&self, value: f64) -> f64 {
        value / self.value - 1.0
    }

    /// What errors below this are made of, nobody can tell.
    pub(super) fn floor(&self) -> f64 {
        const ROUNDING: f64 = 1e-15;
        (3.0 * self.half_width / self.value).max(ROUNDING)
    }

    fn outcome(&self, found: &Estimate) -> Option<Outcome> {
        let half_width = Some(found.half_width() / self.value);
        let error = self.error_of(found.value);
        found.resolved.then_some(Outcome { samples: found.rays, error, half_width })
    }
}

/// Half a decade.
const STEP: f64 = 3.162_277_660_168_379_5;

/// Budgets from some number up to what nobody waits for.
fn budgets(first: f64) -> impl Iterator<Item = u64> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positive, and far from the largest integer"
    )]
    (0..16).map(move |i| (first * STEP.powi(i)).round() as u64)
}

/// Triangles of leaves beyond which facets are left out.
pub(super) const MOST_TRIANGLES: u64 = 4_000_000;

impl Study<'_> {
    pub(super) fn volumes(&self, notes: &mut Vec<String>) -> anyhow::Result<Volumes> {
        let reference = self.reference()?;
        if reference.value <= 0.0 || reference.half_width > 0.01 * reference.value {
            anyhow::bail!(
                "the volume is known only to {:.1e} of {:.3e}: give it more time with --time-limit",
                reference.half_width,
                reference.value
            );
        }
        let mut series = Vec::new();
        let mut add = |name: &str, unit, trials: Vec<_>| {
            // Digits of `adaptive` come all at once.
            let has_order = name != "adaptive";
            let order = order(&trials, reference.floor()).filter(|_| has_order);
            series.push(Series { name: name.to_owned(), unit, trials, order });
        };
        let lattice = |seed, max_rays| {
            let sampling =
                Sampling { rel_tol: 0.0, max_rays, seed, ..Sampling::default() };
            measure::volume_with(self.scene, &sampling, self.watch)
        };
        add(
            "lattice",
            "rays",
            self.sampled(&reference, 0.2, 3728.0, "max-rays", &lattice)?,
        );
        let adaptive = self.adaptive(&reference, notes)?;
        add("adaptive", "rays", adaptive);
        let points = |seed, max_rays| {
            let sampling =
                Sampling { rel_tol: 0.0, max_rays, seed, ..Sampling::default() };
            measure::points(self.scene, &sampling, self.watch)
        };
        add(
            "points",
            "points",
            self.sampled(&reference, 0.08, 1000.0, "max-rays", &points)?,
        );
        add("bracket", "cells", self.bracket(&reference)?);
        add("facets (Manifold)", "triangles", self.facets(&reference, notes)?);
        series.retain(|series| !series.trials.is_empty());
        Ok(Volumes { reference, series })
    }

    /// The volume that can be told best, in a part of the time and with all threads.
    fn reference(&self) -> anyhow::Result<Reference> {
        let mut best: Option<Reference> = None;
        let mut consider = |found: &Estimate| {
            let half_width = found.half_width();
            let (value, method) = (found.value, found.method.name());
            if found.resolved && best.is_none_or(|best| half_width < best.half_width) {
                best = Some(Reference { value, half_width, method });
            }
            half_width <= 1e-11 * value
        };
        if measure::exact(self.solid).is_some_and(|found| consider(&found)) {
            return best.ok_or_else(nothing);
        }
        // Its seed is none of those that are compared with it.
        let sampling = Sampling {
            rel_tol: 1e-12,
            max_rays: u64::MAX,
            time_limit: Some(self.share(0.1)),
            seed: 1 << 40,
            ..Sampling::default()
        };
        let adaptive = measure::adaptive_with(self.scene, &sampling, self.watch);
        if adaptive.is_ok_and(|found| consider(&found)) {
            return best.ok_or_else(nothing);
        }
        let sampling =
            Sampling { rel_tol: 1e-11, time_limit: Some(self.share(0.25)), ..sampling };
        consider(&measure::volume_with(self.scene, &sampling, self.watch));
        best.ok_or_else(nothing)
    }

    /// A method that takes a number of samples.
    fn sampled(
        &self,
        reference: &Reference,
        share: f64,
        first: f64,
        option: &str,
        volume: &(dyn Fn(u64, u64) -> Estimate + Sync),
    ) -> anyhow::Result<Vec<super::Trial>> {
        on_one_thread(|| {
            // What is made ready only once.
            volume(0, 1);
            let rungs = budgets(first).map(|budget| Rung {
                setting: format!("--{option} {budget}"),
                run: Box::new(move |seed| reference.outcome(&volume(seed, budget))),
                is_random: true,
            });
            climb(rungs, self.share(share), STEP)
        })
    }

    fn bracket(&self, reference: &Reference) -> anyhow::Result<Vec<super::Trial>> {
        let run = |max_rays| {
            let sampling = Sampling { rel_tol: 0.0, max_rays, ..Sampling::default() };
            let found = measure::bracket(self.scene, &sampling, self.watch);
            reference.outcome(&found)
        };
        on_one_thread(|| {
            let rungs = budgets(1000.0).map(|budget| Rung {
                setting: format!("--max-rays {budget}"),
                run: Box::new(move |_| run(budget)),
                is_random: false,
            });
            climb(rungs, self.share(0.08), STEP)
        })
    }

    /// One rung a digit.
    fn adaptive(
        &self,
        reference: &Reference,
        notes: &mut Vec<String>,
    ) -> anyhow::Result<Vec<super::Trial>> {
        let limit = self.share(0.1);
        let sampling = |tol: f64| Sampling {
            rel_tol: tol,
            max_rays: u64::MAX,
            time_limit: Some(limit),
            ..Sampling::default()
        };
        if let Err(error) = measure::adaptive_with(self.scene, &sampling(0.1), &unwatched)
        {
            notes.push(format!("adaptive is left out: {error}"));
            return Ok(Vec::new());
        }
        let run = |tol: f64, seed| {
            let sampling = Sampling { seed, ..sampling(tol) };
            let found = measure::adaptive_with(self.scene, &sampling, self.watch).ok()?;
            if found.method != Method::Adaptive {
                return None;
            }
            reference.outcome(&found)
        };
        let trials = on_one_thread(|| {
            let rungs = (2..13).map(|digits| {
                let tol = 10.0_f64.powi(-digits);
                Rung {
                    setting: format!("--rel-tol 1e-{digits}"),
                    run: Box::new(move |seed| run(tol, seed)),
                    is_random: false,
                }
            });
            climb(rungs, limit, 1.5)
        })?;
        if trials.is_empty() && !interrupted() {
            notes.push(
                "adaptive is left out: it found nothing in its part of the time (see --time-limit), or lattices contradict it"
                    .to_owned(),
            );
        }
        Ok(trials)
    }

    /// What OpenSCAD's facets make of the volume.
    fn facets(
        &self,
        reference: &Reference,
        notes: &mut Vec<String>,
    ) -> anyhow::Result<Vec<super::Trial>> {
        let limit = self.share(0.2);
        let deadline = Instant::now().checked_add(2 * limit);
        let watch = |_| {
            let is_late = deadline.is_some_and(|deadline| Instant::now() > deadline);
            if is_late { std::ops::ControlFlow::Break(()) } else { (self.watch)(0) }
        };
        let volume = |segments| -> Result<Outcome, FacetsError> {
            let faceted = facets::faceted(self.solid, segments, MOST_TRIANGLES)?;
            let mesh = facets::boundary(&faceted, &watch)?;
            let (volume, samples) =
                mesh.map_or((0.0, 0), |mesh| (mesh.volume(), mesh.faces().len() as u64));
            let error = reference.error_of(volume);
            Ok(Outcome { samples, error, half_width: None })
        };
        let refused = std::cell::RefCell::new(None);
        let run = |segments| match volume(segments) {
            Ok(outcome) => Some(outcome),
            Err(error) => {
                *refused.borrow_mut() = Some((segments, error));
                None
            }
        };
        let has_curves = facets::faceted(self.solid, 8, MOST_TRIANGLES)
            .is_ok_and(|faceted| faceted.curves > 0);
        let segments = if has_curves { 3..10 } else { 3..4 };
        let rungs = segments.map(|power| {
            let segments = 1 << power;
            Rung {
                setting: format!("$fn = {segments}"),
                run: Box::new(move |_| run(segments)),
                is_random: false,
            }
        });
        let trials = climb(rungs, limit, 2.0);
        if let Some((segments, error)) = refused.into_inner() {
            notes.push(format!("facets end before {segments} segments: {error}"));
        } else if !has_curves && !trials.is_empty() {
            notes.push(
                "the model has no curves: its facets are the solid itself".to_owned(),
            );
        }
        Ok(trials)
    }
}

fn nothing() -> anyhow::Error {
    anyhow::anyhow!(
        "the solid is too thin for its bounds: too few rays meet it in this time; --time-limit gives it more"
    )
}
