//! Facets: the polyhedra that stand for curves, and the surfaces of solids as meshes.

#[expect(dead_code, reason = "facets need no rays")]
mod support;

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::path::Path;

use glam::{DAffine3, DVec3, dvec3};
use proptest::prelude::*;
use solidray::facets::{self, Faceted, FacetsError, boundary, faceted};
use solidray::measure::{self, Sampling};
use solidray::read::{self, Curves, Format, ReadOptions};
use solidray::{Mesh, Op, Scene, Solid, unwatched};
use support::leaf;

const MANY: u64 = 1 << 20;

fn facets(solid: &Solid, segments: u32) -> Faceted {
    faceted(solid, segments, MANY).expect("it has facets")
}

fn surface(solid: &Solid, segments: u32) -> Option<Mesh> {
    boundary(&facets(solid, segments), &unwatched).expect("Manifold takes it")
}

/// What the surface encloses.
fn volume(solid: &Solid, segments: u32) -> f64 {
    surface(solid, segments).map_or(0.0, |mesh| mesh.volume())
}

fn near(a: f64, b: f64) {
    assert!((a / b - 1.0).abs() < 1e-12, "{a} and {b}");
}

#[test]
fn polyhedra_have_the_volumes_of_their_formulas() {
    for n in [3, 8, 100] {
        let circle = 0.5 * f64::from(n) * (TAU / f64::from(n)).sin();
        near(volume(&Solid::cylinder(2.0, 3.0), n), 12.0 * circle);
        let cone = Solid::frustum(1.0, 2.0, 3.0);
        near(volume(&cone, n), (1.0 + 2.0 + 4.0) * circle);
        near(volume(&Solid::frustum(1.0, 0.0, 3.0), n), circle);
        near(volume(&Solid::cuboid(dvec3(1.0, 2.0, 3.0)), n), 6.0);
    }
    // With more segments it comes near, like their number squared.
    let missing = |n| 1.0 - volume(&Solid::ball(1.0), n) / (4.0 / 3.0 * PI);
    assert!(missing(64) > 0.0 && (missing(64) / missing(128) - 4.0).abs() < 0.1);
}

/// The facets of a solid of curves are those that the reader makes of the text.
#[test]
fn they_are_those_of_openscad() {
    let text = "difference() {
        sphere($fn = 10, $fa = 12, $fs = 2, r = 5);
        cylinder($fn = 10, $fa = 12, $fs = 2, h = 7, r1 = 1, r2 = 2, center = true);
        cube(size = [4, 4, 4], center = false);
    }";
    let read = |curves| {
        let options = ReadOptions { curves, ..ReadOptions::default() };
        read::bytes(text.as_bytes(), Path::new("text"), Format::Csg, &options)
            .expect("a model")
            .solid
    };
    let ours = facets(&read(Curves::Exact), 10);
    assert_eq!(ours.curves, 2);
    let theirs = facets(&read(Curves::Faceted), 99);
    assert_eq!((theirs.curves, theirs.triangles), (0, ours.triangles));
    let mesh = |faceted| boundary(faceted, &unwatched).expect("Manifold takes it");
    assert_eq!(mesh(&ours), mesh(&theirs));
}

#[test]
fn what_has_no_facets_is_refused() {
    let refused = |solid: &Solid| faceted(solid, 8, MANY).expect_err("it has none");
    let half = Solid::cuboid(DVec3::ONE) & Solid::half_space(DVec3::Z, 0.0);
    assert_eq!(refused(&half), FacetsError::NoFacets("half-space"));
    let bowl = Solid::paraboloid(1.0, 1.0);
    assert_eq!(refused(&bowl), FacetsError::NoFacets("paraboloid"));
    let ball = Solid::ball(1.0);
    let too_few = faceted(&ball, 2, MANY).expect_err("two segments");
    assert_eq!(too_few, FacetsError::TooFewSegments(2));
    let too_many = faceted(&ball, u32::MAX, MANY).expect_err("a billion triangles");
    assert!(matches!(too_many, FacetsError::TooMany { limit: MANY, .. }));
    // Each is small, but there are many of them.
    let mut many = ball.clone();
    for _ in 0..60 {
        many = many.clone() + many.translated(DVec3::X);
    }
    assert!(matches!(faceted(&many, 8, MANY), Err(FacetsError::TooMany { .. })));
    let two = facets(&(ball.clone() + ball.translated(DVec3::X)), 8);
    let stopped = boundary(&two, &|_| ControlFlow::Break(()));
    assert_eq!(stopped, Err(FacetsError::Stopped));
}

#[test]
fn nothing_has_an_empty_surface() {
    let mut nothing = Solid::boolean(Op::Union, []);
    for _ in 0..60 {
        nothing = nothing.clone() + nothing.translated(DVec3::X);
    }
    assert!(surface(&nothing, 8).is_none());
    let ball = Solid::ball(1.0);
    assert!(surface(&(ball.clone() - ball.clone()), 8).is_none());
    near(volume(&(ball.clone() + nothing), 8), volume(&ball, 8));
}

#[test]
fn long_chains_do_not_grow_the_stack() {
    let mut chain = Solid::cuboid(DVec3::ONE);
    for _ in 0..20_000 {
        chain = chain.translated(1e-3 * DVec3::X);
    }
    let mesh = surface(&chain, 8).expect("a box");
    assert!((mesh.bounds().min.x - 19.5).abs() < 1e-6, "{:?}", mesh.bounds());
}

/// A tree of boxes, balls and cylinders in general position.
fn tree() -> impl Strategy<Value = Solid> {
    let leaf =
        (0..3_u8, prop::array::uniform3(-1.0..1.0), prop::array::uniform3(0.4..1.2))
            .prop_map(|(kind, at, [a, b, c])| {
                let solid = match kind {
                    0 => Solid::cuboid(dvec3(a, b, c)),
                    1 => Solid::ball(a),
                    _ => Solid::cylinder(a, b),
                };
                let map = DAffine3::from_axis_angle(dvec3(a, b, c).normalize(), 3.0 * a)
                    * DAffine3::from_scale(dvec3(1.0, -1.0, 1.5));
                solid.mapped(DAffine3::from_translation(at.into()) * map)
            });
    leaf.prop_recursive(3, 6, 2, |inner| {
        (0..3_u8, inner.clone(), inner).prop_map(|(op, a, b)| match op {
            0 => a + b,
            1 => a - b,
            _ => a & b,
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Rays through the tree of meshes, rays through its surface, and the divergence theorem
    /// agree.
    #[test]
    fn surfaces_enclose_what_trees_say(solid in tree()) {
        let faceted = facets(&solid, 9);
        let mesh = boundary(&faceted, &unwatched).expect("Manifold takes it");
        let sampling = Sampling { rel_tol: 1e-3, max_rays: 1 << 18, ..Sampling::default() };
        let enclosed = mesh.as_ref().map_or(0.0, Mesh::volume);
        for solid in [Some(faceted.solid), mesh.map(Solid::mesh)].into_iter().flatten() {
            let scene = Scene::compile(&solid).expect("a solid");
            let found = measure::volume(&scene, &sampling);
            let room = 3.0 * found.half_width() + 1e-9;
            prop_assert!((found.value - enclosed).abs() <= room, "{found:?} {enclosed}");
        }
    }

    /// What is said of a leaf's facets is what is said of its faces, its bounds and its volume.
    #[test]
    fn facets_of_leaves_enclose_them(leaf in leaf::bounded()) {
        const TOLERANCE: f64 = 0.01;
        let solid = leaf.solid();
        let mesh = match facets::surface(&solid, TOLERANCE, MANY, &unwatched) {
            Ok(mesh) => mesh.expect("leaves are not empty"),
            Err(FacetsError::NoFacets(_)) => return Ok(()),
            Err(error) => panic!("{error}"),
        };
        let is_polyhedron = leaf.wall::<f64>().is_none();
        let scene = Scene::compile(&solid).expect("a leaf");
        let room = if is_polyhedron { 1e-12 } else { TOLERANCE };
        for (a, b) in [
            (mesh.bounds().min, scene.bounds().min),
            (mesh.bounds().max, scene.bounds().max),
        ] {
            prop_assert!((a - b).abs().max_element() <= room, "{a} {b}");
        }
        for &point in mesh.points() {
            let outside = leaf.planes().into_iter().map(|(normal, offset)| {
                (normal.dot(point) - offset) / normal.length()
            });
            prop_assert!(outside.fold(f64::NEG_INFINITY, f64::max) <= room, "{point}");
        }
        if let Some(volume) = measure::exact(&solid) {
            let room = if is_polyhedron { 1e-12 } else { TOLERANCE };
            let off = (mesh.volume() / volume.value - 1.0).abs();
            prop_assert!(off <= room, "{} {volume:?}", mesh.volume());
        }
    }

    #[test]
    fn unions_and_intersections_make_up_their_operands(a in tree(), b in tree()) {
        let volume = |solid: &Solid| volume(solid, 9);
        let parts = volume(&a) + volume(&b);
        let both = volume(&(a.clone() + b.clone())) + volume(&(a & b));
        prop_assert!((both - parts).abs() < 1e-9 * (1.0 + parts), "{both} {parts}");
    }
}
