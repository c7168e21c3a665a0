//! The models of this repository against closed forms, Manifold and OpenSCAD.

#[path = "support/openscad.rs"]
mod openscad;
#[expect(dead_code, reason = "models need no random solids")]
mod support;

use std::fs;
use std::path::{Path, PathBuf};

use solidray::measure::{self, Estimate, Sampling};
use solidray::read::{self, Curves, ReadOptions};
use solidray::{Scene, Solid};

/// A row of `models/references.csv`.
struct Reference {
    name: String,
    closed: Option<f64>,
    openscad: f64,
    manifold: f64,
}

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("models")
}

fn references() -> Vec<Reference> {
    let text =
        fs::read_to_string(models().join("references.csv")).expect("the file is there");
    let rows: Vec<Reference> = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .skip(1)
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let number = |i: usize| fields[i].parse::<f64>();
            Reference {
                name: fields[0].to_owned(),
                closed: number(1).ok(),
                openscad: number(2).expect("a volume"),
                manifold: number(3).expect("a volume"),
            }
        })
        .collect();
    assert!(rows.len() >= 12);
    rows
}

fn solid(name: &str, curves: Curves) -> Solid {
    let options = ReadOptions { curves, ..ReadOptions::default() };
    let file = models().join(format!("{name}.csg"));
    read::file(&file, &options).unwrap_or_else(|error| panic!("{error}")).solid
}

fn volume(solid: &Solid) -> Estimate {
    let sampling = Sampling { rel_tol: 3e-4, ..Sampling::default() };
    let volume = measure::volume(&support::scene(solid), &sampling);
    assert!(volume.target_met);
    volume
}

/// A 95 % interval widened to one that holds in 999 of 1,000 cases (Student's t with 15
/// degrees of freedom: 4.07 against 2.13), so that dozens of checks do not fail by chance.
fn agrees(volume: &Estimate, reference: f64) -> bool {
    (volume.value - reference).abs() <= 1.91 * volume.half_width()
}

#[test]
fn every_model_has_a_reference_and_compiles_with_every_kind_of_curves() {
    let names: Vec<String> = references().into_iter().map(|r| r.name).collect();
    for entry in fs::read_dir(models()).expect("the folder is there") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "csg") {
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            assert!(names.contains(&name), "{name} is not in references.csv");
            for curves in [Curves::Auto, Curves::Exact, Curves::Faceted] {
                let scene = Scene::compile(&solid(&name, curves)).expect(&name);
                assert!(scene.bounds().is_bounded(), "{name}");
            }
        }
    }
}

#[test]
fn true_curves_have_the_volume_of_the_closed_form() {
    for Reference { name, closed, .. } in references() {
        let Some(closed) = closed else { continue };
        let volume = volume(&solid(&name, Curves::Auto));
        assert!(agrees(&volume, closed), "{name}: {volume:?}, exact {closed}");
    }
}

#[test]
fn faceted_models_have_the_volume_of_openscads_polyhedra() {
    for Reference { name, manifold, openscad, .. } in references() {
        let volume = volume(&solid(&name, Curves::Faceted));
        assert!(agrees(&volume, manifold), "{name}: {volume:?}, Manifold {manifold}");
        assert!(
            (openscad / manifold - 1.0).abs() < 1e-6,
            "{name}: the references differ"
        );
    }
}

#[test]
fn facets_given_to_manifold_have_the_recorded_volume() {
    for Reference { name, manifold: recorded, .. } in references() {
        let volume = openscad::enclosed(&solid(&name, Curves::Faceted));
        assert!(
            (volume / recorded - 1.0).abs() < 1e-9,
            "{name}: {volume}, not {recorded}"
        );
    }
}

/// Without it the recorded values have to do, which the tests above compare with.
fn is_installed() -> bool {
    openscad::is_installed("its recorded volumes are used instead")
}

#[test]
fn openscad_makes_the_same_volume_now_as_when_it_was_recorded() {
    if !is_installed() {
        return;
    }
    for Reference { name, openscad: recorded, .. } in references() {
        // Those that take its exact arithmetic a few seconds at most.
        if !["ball", "classic", "flange", "bracket", "pencils", "dovetail"]
            .contains(&&*name)
        {
            continue;
        }
        let volume = openscad::volume_of(&models().join(format!("{name}.csg")));
        // Its files have six digits.
        assert!(
            (volume / recorded - 1.0).abs() < 1e-5,
            "{name}: {volume}, not {recorded}"
        );
    }
}

#[test]
fn scad_files_give_what_their_csg_files_give() {
    if !is_installed() {
        return;
    }
    for name in ["classic", "die", "gear", "asteroid"] {
        let scad = models().join(format!("{name}.scad"));
        let found = read::file(&scad, &ReadOptions::default());
        let solid_of_scad = found.unwrap_or_else(|error| panic!("{error}")).solid;
        let recorded = solid(name, Curves::Auto);
        assert_eq!(solid_of_scad.census(), recorded.census(), "{name}");
        let sampling = Sampling { rel_tol: 1e-2, ..Sampling::default() };
        let [a, b] = [&solid_of_scad, &recorded]
            .map(|solid| measure::volume(&support::scene(solid), &sampling));
        assert_eq!(a, b, "{name}");
    }
}
