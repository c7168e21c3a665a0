//! Prisms and pyramids beside the polyhedra that OpenSCAD makes, and flush with plates.

#[expect(dead_code, reason = "prisms need no trees")]
mod support;

use std::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2};

use glam::{DAffine3, DMat3, DVec3, dvec3};
use solidray::facets::{self, FacetsError};
use solidray::primitive::{Primitive, Prism};
use solidray::{CompileError, CompileOptions, Ray, Scene, Solid, measure, unwatched};
use support::dice::Dice;
use support::{ends_in, scene};

/// The polyhedron that OpenSCAD makes of a frustum with this `$fn`.
fn polyhedron(sides: u32, [a, b]: [f64; 2], height: f64) -> Solid {
    let frustum = Solid::frustum(a, b, height);
    facets::faceted(&frustum, sides, 1000).expect("it has facets").solid
}

#[test]
fn prisms_are_the_polyhedra_that_openscad_makes() {
    let dice = &mut Dice::new(1);
    let mut crossed = 0;
    for sides in 3..=8 {
        for radii in [[2.0, 2.0], [2.0, 0.5], [0.5, 2.0], [2.0, 0.0], [0.0, 2.0]] {
            let turn = dice.rotation();
            let map = DAffine3::from_mat3_translation(turn, dice.point(3.0));
            let prism = Solid::prism_between(sides, radii, [0.0, 3.0]).mapped(map);
            let mesh = polyhedron(sides, radii, 3.0).mapped(map);
            let (prism, mesh) = (scene(&prism), scene(&mesh));
            for (a, b) in [
                (prism.bounds().min, mesh.bounds().min),
                (prism.bounds().max, mesh.bounds().max),
            ] {
                assert!((a - b).abs().max_element() < 1e-14, "{sides} {radii:?}");
            }
            for _ in 0..100 {
                let through = map.transform_point3(dice.point(2.0) + DVec3::Z);
                let dir = dice.direction();
                let ray = Ray::new(through - 10.0 * dir, dir);
                let (found, expected) = (ends_in(&prism, &ray), ends_in(&mesh, &ray));
                assert_eq!(found.len(), expected.len(), "{sides} {radii:?} {ray:?}");
                for (found, expected) in
                    found.iter().flatten().zip(expected.iter().flatten())
                {
                    assert!(
                        (found - expected).abs() < 1e-12,
                        "{sides} {radii:?} {ray:?}"
                    );
                    crossed += 1;
                }
            }
        }
    }
    assert!(crossed > 2000, "{crossed}");
}

/// A hexagonal hole through a plate, as long as the plate is thick, is open at both ends.
#[test]
fn a_hole_that_is_flush_with_both_faces_leaves_no_film() {
    let plate = Solid::cuboid_between(dvec3(-5.0, -5.0, 0.0), dvec3(5.0, 5.0, 5.0));
    for (sides, radii) in [(6, [3.0, 3.0]), (3, [3.0, 3.0]), (8, [2.0, 3.0])] {
        let hole = Solid::prism_between(sides, radii, [0.0, 5.0]);
        let scene = scene(&(plate.clone() - hole));
        let mut tracer = scene.tracer();
        let dice = &mut Dice::new(u64::from(sides));
        for _ in 0..1000 {
            let at = 0.9 * dice.point(1.0);
            let dir = dvec3(0.05 * at.y, 0.05 * at.z, 1.0);
            let ray = Ray::new(dvec3(at.x, at.y, 2.5) - 10.0 * dir, dir);
            assert!(tracer.spans(&ray).is_empty(), "{ray:?}");
            assert_eq!(tracer.uncertain(&ray), 0, "{ray:?}");
            assert!(!tracer.contains(dvec3(at.x, at.y, 0.0)));
            assert!(!tracer.contains(dvec3(at.x, at.y, 5.0)));
        }
    }
}

#[test]
fn volumes_are_those_of_their_polygons() {
    for sides in 3..=30 {
        let n = f64::from(sides);
        let polygon = 0.5 * n * (2.0 * PI / n).sin();
        for (radii, square) in
            [([2.0, 2.0], 4.0), ([3.0, 0.0], 3.0), ([1.0, 2.0], 7.0 / 3.0)]
        {
            let prism = Solid::prism_between(sides, radii, [-1.0, 4.0]);
            let found = measure::exact(&prism).expect("there is a formula");
            let expected = polygon * 5.0 * square;
            assert!((found.value - expected).abs() < 1e-14 * expected, "{sides}");
            let [low, high] = found.interval;
            assert!(high - low < 1e-13 * expected, "{sides}");
        }
    }
}

/// Where a prism of four sides is turned to the axes it is a box, and cuts as one.
#[test]
fn a_square_prism_along_the_axes_is_a_box() {
    let cube = Solid::cuboid(dvec3(10.0, 10.0, 10.0));
    let turn = FRAC_1_SQRT_2
        * DMat3::from_cols(
            dvec3(1.0, 1.0, 0.0),
            dvec3(-1.0, 1.0, 0.0),
            SQRT_2 * DVec3::Z,
        );
    let cutter = Solid::prism_between(4, [50.0_f64.sqrt(); 2], [-10.0, 10.0])
        .mapped(DAffine3::from_mat3(turn));
    let bounds = scene(&cutter).bounds();
    assert!((bounds.max - dvec3(5.0, 5.0, 10.0)).abs().max_element() < 1e-14);
    let options = CompileOptions { weld: 1e-4, ..CompileOptions::default() };
    let rest = Scene::compile_with(&(cube - cutter), &options).expect("it compiles");
    assert!(rest.bounds().is_empty() || rest.bounds().size().min_element() == 0.0);
}

/// Nothing is made of sizes that are not right, however large the mesh would be.
#[test]
fn facets_are_not_made_of_bad_sizes() {
    for (sides, radius, height) in [
        (u32::MAX, 1.0, 1.0),
        (2, 1.0, 1.0),
        (6, -1.0, 1.0),
        (6, f64::NAN, 1.0),
        (6, 1.0, -1.0),
    ] {
        let prism = Solid::prism(sides, radius, height);
        let found = facets::faceted(&prism, 8, 1000).err();
        assert!(
            matches!(found, Some(FacetsError::BadParameter { leaf: "prism", .. })),
            "{sides} {radius} {height}: {found:?}"
        );
        let found = facets::surface(&prism, 0.1, 1000, &unwatched).err();
        assert!(matches!(found, Some(FacetsError::BadParameter { .. })), "{found:?}");
    }
}

#[test]
fn prisms_without_inside_are_refused() {
    for (sides, radii, ends, named) in [
        (2, [1.0, 1.0], [0.0, 1.0], "number of sides"),
        (31, [1.0, 1.0], [0.0, 1.0], "number of sides"),
        (6, [0.0, 0.0], [0.0, 1.0], "larger radius"),
        (6, [-1.0, 1.0], [0.0, 1.0], "bottom radius"),
        (6, [1.0, f64::NAN], [0.0, 1.0], "top radius"),
        (6, [1.0, 1.0], [1.0, 1.0], "height"),
        (6, [1e200, 0.0], [0.0, 1.0], "larger radius"),
        (6, [1.0, 0.0], [0.0, 1e-200], "height"),
        (6, [1.0, 1.0], [f64::NEG_INFINITY, 1.0], "bottom"),
    ] {
        let prism = Solid::primitive(Primitive::Prism(Prism { sides, radii, ends }));
        match Scene::compile(&prism) {
            Err(CompileError::BadParameter { parameter, .. }) => {
                assert_eq!(parameter, named);
            }
            other => panic!("{named}: {other:?}"),
        }
    }
}
