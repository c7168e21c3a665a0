//! Closed meshes under rays that hit corners, run along edges and lie in faces.
//!
//! Random rays show nothing here: methods that lose a third of these have no fault in
//! 30,000 random ones. In builds with debug assertions the tracer itself checks that every
//! leaf is left as often as it is entered; `src/shape/watertight.rs` looks at the crossings
//! before they are sorted.

#[expect(dead_code, reason = "meshes are made and not drawn by lot here")]
mod support;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, dvec3};
use solidray::primitive::{Cuboid, Primitive};
use solidray::read::{self, Curves, ReadOptions};
use solidray::{Crossing, Mesh, Ray, Scene, Sense, Solid, Span, View};
use support::aim::{at_feature, mapped};
use support::dice::Dice;
use support::nearness::disagreement;
use support::{assert_spans_valid, ends, ends_in, meshes, scene, spans};

/// How many rays are aimed at each mesh.
const RAYS: usize = 12_000;

/// How many rays are aimed at each model, in each of two ways to read it and from both
/// sides.
const MODEL_RAYS: usize = 3_000;

struct Case {
    name: &'static str,
    mesh: Mesh,
    map: DAffine3,
    /// Whether it stays convex when rounding moves its points.
    is_convex: bool,
}

fn cases() -> Vec<Case> {
    let plain =
        |name, mesh, is_convex| Case { name, mesh, map: DAffine3::IDENTITY, is_convex };
    let ball = || meshes::icosphere(3);
    let far = DAffine3::from_translation(dvec3(148_376.0, 1234.0, -223_423.0));
    let sheared = DAffine3::from_mat3_translation(
        DMat3::from_cols(
            dvec3(-1.0, 0.3, 0.0),
            dvec3(0.2, 0.7, 0.1),
            dvec3(0.0, 0.4, 1.3),
        ),
        dvec3(0.1, -0.2, 0.3),
    );
    vec![
        plain("icosphere", ball(), true),
        plain("jittered icosphere", meshes::jittered(&ball(), 0.1, 1), false),
        plain("uv sphere", meshes::uv_sphere(48, 24), false),
        plain("lattice cube", meshes::grid_box(-DVec3::ONE, DVec3::ONE, 8), true),
        plain("far icosphere", meshes::mapped(&ball(), &far), true),
        Case { map: far, ..plain("icosphere moved far", ball(), true) },
        plain("needle", meshes::needle(1e8), true),
        plain("cubes with one corner", meshes::touching_cubes(1), false),
        plain("cubes with one edge", meshes::touching_cubes(2), false),
        Case { map: sheared, ..plain("mirrored and sheared icosphere", ball(), true) },
        Case {
            map: sheared,
            ..plain(
                "mirrored and sheared grid",
                meshes::grid_box(DVec3::ZERO, DVec3::ONE, 3),
                false,
            )
        },
    ]
}

/// Gaps shorter than this, in units of coordinates, are rounding: a few units in the last
/// place of what is at hand.
const ROUNDING: f64 = 1e-13;

/// Spans between which there is more than rounding.
fn pieces(spans: &[Span], ray: &Ray, scene: &Scene) -> usize {
    let bounds = scene.bounds();
    let coordinates = bounds.min.abs().max(bounds.max.abs()).max_element();
    let gap = |pair: &&[Span]| {
        let width = (pair[1].enter.t - pair[0].exit.t) * ray.dir.abs().max_element();
        width > ROUNDING * (coordinates + ray.origin.abs().max_element())
    };
    spans.windows(2).filter(gap).count() + usize::from(!spans.is_empty())
}

#[test]
fn n16_spans_of_rays_at_features_are_valid_and_one_in_convex_meshes() {
    for Case { name, mesh, map, is_convex } in cases() {
        let scene = scene(&Solid::mesh(mesh.clone()).mapped(map));
        let (mut tracer, mut dice) = (scene.tracer(), Dice::new(3));
        let mut hits = 0;
        for i in 0..RAYS {
            let ray = mapped(&at_feature(&mesh, &mut dice, i), &map);
            let spans = tracer.spans(&ray);
            assert_spans_valid(&scene, &ray, spans);
            hits += usize::from(!spans.is_empty());
            if is_convex {
                assert!(pieces(spans, &ray, &scene) <= 1, "{name}: {ray:?}: {spans:?}");
            }
        }
        assert!(hits > RAYS / 5, "{name}: only {hits} hits");
    }
}

/// The bounds of a corner's surroundings: a line that passes a corner or an edge of a
/// convex mesh well inside its outline must hit.
#[test]
fn no_ray_slips_through_an_edge() {
    let mesh = meshes::icosphere(3);
    let scene = scene(&Solid::mesh(mesh.clone()));
    let (mut tracer, mut dice) = (scene.tracer(), Dice::new(4));
    for i in 0..RAYS {
        let face = mesh.faces()[dice.below(mesh.faces().len())];
        let [a, b, _] = face.map(|i| mesh.points()[i as usize]);
        let at = if i % 2 == 0 { a } else { a + dice.within(0.0, 1.0) * (b - a) };
        let from = 3.0 * at + 0.5 * dice.direction();
        let ray = Ray::new(from, at - from);
        let spans = tracer.spans(&ray);
        assert_eq!(spans.len(), 1, "{ray:?}");
        assert!((spans[0].enter.t - 1.0).abs() < 1e-14, "{ray:?}: {spans:?}");
    }
}

/// The surfaces of all leaves as one mesh.
fn skin(solid: &Solid) -> Mesh {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    let mut rest = vec![(solid, DAffine3::IDENTITY)];
    while let Some((solid, map)) = rest.pop() {
        let mesh = match solid.view() {
            View::Primitive(Primitive::Cuboid(Cuboid { min, max })) => {
                &Arc::new(meshes::grid_box(*min, *max, 1))
            }
            View::Mesh(mesh) => mesh,
            View::Boolean(_, children) => {
                rest.extend(children.iter().map(|child| (child, map)));
                continue;
            }
            View::Mapped(inner, child) => {
                rest.push((child, map * *inner));
                continue;
            }
            View::Tagged(child) => {
                rest.push((child, map));
                continue;
            }
            View::Primitive(_) | _ => panic!("{solid:?} has no facets"),
        };
        let first = u32::try_from(points.len()).expect("few points");
        points.extend(mesh.points().iter().map(|&p| map.transform_point3(p)));
        let is_mirrored = map.matrix3.determinant() < 0.0;
        faces.extend(mesh.faces().iter().map(|face| {
            let [a, b, c] = face.map(|i| i + first);
            if is_mirrored { [a, c, b] } else { [a, b, c] }
        }));
    }
    Mesh::new(points, faces).expect("closed meshes together are closed")
}

/// Rays at the corners, edges and faces that OpenSCAD's polygons have,
/// which lie on the true curves too.
#[test]
fn n16_spans_of_rays_at_features_of_the_models_are_valid_and_the_same_from_behind() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let entries = std::fs::read_dir(folder).expect("the models are there");
    let mut paths: Vec<PathBuf> = entries.map(|e| e.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "csg"));
    paths.sort();
    assert!(paths.len() >= 18);
    let read = |path: &Path, curves| {
        let options = ReadOptions { curves, ..ReadOptions::default() };
        read::file(path, &options).expect("the model is right").solid
    };
    for path in paths {
        let faceted = read(&path, Curves::Faceted);
        let (skin, mut dice) = (skin(&faceted), Dice::new(16));
        let scenes = [scene(&faceted), scene(&read(&path, Curves::Auto))];
        let mut hits = 0;
        for i in 0..MODEL_RAYS {
            let ray = at_feature(&skin, &mut dice, i);
            let [there, curved] = [0, 1].map(|k| spans(&scenes[k], &ray));
            hits += usize::from(!there.is_empty()) + usize::from(!curved.is_empty());
            let back = spans(&scenes[0], &Ray::new(ray.origin, -ray.dir));
            let back: Vec<Span> = back.iter().rev().map(mirrored).collect();
            let apart = disagreement(&skin, &ray, &there, &back);
            assert!(apart <= 4.0, "{}: {i}: {apart} ulp: {ray:?}", path.display());
        }
        assert!(hits > MODEL_RAYS / 5, "{}: only {hits} hits", path.display());
    }
}

/// A span of the reversed ray as one of the ray.
fn mirrored(span: &Span) -> Span {
    let back = |crossing: Crossing, sense| Crossing { t: -crossing.t, sense, ..crossing };
    Span { enter: back(span.exit, Sense::Enter), exit: back(span.enter, Sense::Exit) }
}

/// Two boxes side by side, each with a map of its own; rays through the face they share.
fn abutting(map: DAffine3, dice: &mut Dice) -> Vec<[f64; 2]> {
    let (a, b) =
        (dvec3(dice.within(0.1, 3.0), 1.0, 1.0), dvec3(dice.within(0.1, 3.0), 1.0, 1.0));
    let (low, beside) = (dice.point(1.0), dvec3(a.x, 0.0, 0.0));
    let from_box = |corner: DVec3| map * DAffine3::from_translation(corner);
    let place = |size: DVec3, corner: DVec3| {
        Solid::cuboid_between(DVec3::ZERO, size).mapped(from_box(corner))
    };
    let at = low + beside + dvec3(0.0, dice.within(0.1, 0.9), dice.within(0.1, 0.9));
    let dir = DVec3::X + 0.02 * dice.direction();
    let ray = mapped(&Ray::new(at - 5.0 * dir, dir), &map);
    ends(&(place(a, low) + place(b, low + beside)), &ray)
}

#[test]
fn boxes_with_a_common_coordinate_are_one_wherever_they_are() {
    let mut dice = Dice::new(8);
    for i in 0..1000 {
        let reach = 10.0_f64.powi(i % 5);
        let (low, size) = (dice.point(reach), dvec3(dice.within(0.1, 3.0), 1.0, 1.0));
        let middle = low.x + size.x;
        let a = Solid::cuboid_between(low, dvec3(middle, low.y + 1.0, low.z + 1.0));
        let b = Solid::cuboid_between(DVec3::ZERO, size)
            .translated(dvec3(middle, low.y, low.z));
        let at =
            dvec3(middle, low.y + dice.within(0.1, 0.9), low.z + dice.within(0.1, 0.9));
        let dir = DVec3::X + 0.02 * dice.direction();
        let list = ends(&(a + b), &Ray::new(at - 5.0 * dir, dir));
        assert_eq!(list.len(), 1, "{list:?}");
    }
}

/// Their maps are multiplied out separately, so without one plane for both faces about a
/// third would be parted by a rounding error and another third overlap.
#[test]
fn n27_rotated_boxes_with_a_common_face_are_one_span() {
    let mut dice = Dice::new(9);
    for _ in 0..1000 {
        let map = DAffine3::from_mat3(dice.rotation());
        let list = abutting(map, &mut dice);
        assert_eq!(list.len(), 1, "{list:?}");
    }
}

/// The same solid, its mesh another one in memory.
fn again(leaf: &Solid) -> Solid {
    match leaf.view() {
        View::Mapped(map, child) => again(child).mapped(*map),
        View::Mesh(mesh) => Solid::mesh(Mesh::clone(mesh)),
        View::Primitive(_) | View::Boolean(..) | View::Tagged(_) | _ => leaf.clone(),
    }
}

/// What rounding can have done along an axis has nothing to do with how a leaf is stretched
/// along the others.
#[test]
fn real_gaps_beside_stretched_leaves_stay() {
    for (stretch, gap) in [(1e4, 1e-8), (1e6, 1e-5), (1e6, 1e-6)] {
        let wide = Solid::cuboid_between(DVec3::ZERO, DVec3::ONE)
            .scaled(dvec3(stretch, stretch, 1.0))
            .translated(dvec3(0.0, 0.0, 1.0 + gap));
        let solid = Solid::cuboid_between(DVec3::ZERO, DVec3::ONE) + wide;
        let list = ends(&solid, &Ray::new(dvec3(0.5, 0.5, -5.0), DVec3::Z));
        assert_eq!(list.len(), 2, "{stretch:e}, {gap:e}: {list:?}");
    }
}

/// The same solid by another product of maps: what is left of it, in all of a thousand
/// cases, is nothing, seen along lines through its corners and faces.
#[test]
fn n26_copies_by_differently_written_maps_leave_nothing() {
    let mut dice = Dice::new(10);
    let leaves = [
        Solid::cuboid(dvec3(2.0, 3.0, 1.0)),
        Solid::ball(1.5),
        Solid::cylinder(1.2, 2.0),
        Solid::frustum(2.0, 0.5, 1.5),
        Solid::frustum(1.0, 0.0, 2.0),
        Solid::paraboloid(1.5, 2.0),
        Solid::hyperboloid_of_one_sheet(1.0, 1.6, 2.0),
        Solid::hyperboloid_of_two_sheets(0.5, 0.8, 3.0),
        Solid::mesh(meshes::jittered(&meshes::icosphere(1), 0.1, 5)),
    ];
    for i in 0..1000 {
        let (axis, angle, offset) =
            (dice.direction(), dice.within(-3.0, 3.0), dice.point(20.0));
        let factor = dvec3(dice.within(0.3, 3.0), dice.within(-3.0, -0.3), 1.5);
        let leaf = leaves[i % leaves.len()].clone().scaled(factor);
        let once = leaf.clone().rotated(axis, angle).translated(offset);
        let thrice = again(&leaf)
            .translated(DVec3::ONE)
            .rotated(axis, 0.3 * angle)
            .rotated(axis, 0.7 * angle)
            .translated(offset - DQuat::from_axis_angle(axis, angle) * DVec3::ONE);
        for left in [once.clone() - thrice.clone(), thrice - once] {
            let scene = scene(&left);
            for _ in 0..20 {
                let target = offset + dice.point(2.0);
                let ray = Ray::new(target, dice.direction());
                assert_eq!(ends_in(&scene, &ray), [] as [[f64; 2]; 0], "{i}");
            }
        }
    }
}

/// Products of four such coordinates are no numbers.
#[test]
fn meshes_may_be_as_large_or_small_as_numbers_go() {
    for size in [1e-300, 1e-160, 1e-110, 1e110, 1e160, 1e300] {
        let mesh = meshes::mapped(
            &meshes::icosphere(1),
            &DAffine3::from_scale(DVec3::splat(size)),
        );
        let scene = scene(&Solid::mesh(mesh));
        let mut dice = Dice::new(12);
        for _ in 0..200 {
            let (inside, outside) = (0.9 * dice.point(0.5), 1.1 * dice.direction());
            assert!(scene.contains(size * inside), "{size}: {inside}");
            assert!(!scene.contains(size * outside), "{size}: {outside}");
            let ray = Ray::new(size * inside, dice.direction());
            let list = spans(&scene, &ray);
            assert_eq!(list.len(), 1, "{size}: {inside}");
            let Crossing { t, .. } = list[0].exit;
            let normal = scene.normal_at(&ray, &list[0].exit);
            let outward = (ray.at(t) / size).normalize();
            assert!(normal.dot(outward) > 0.9, "{size}: {normal} at {outward}");
        }
    }
}
