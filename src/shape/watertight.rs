//! The crossings of meshes with lines aimed at their corners, edges and faces, before any
//! sorting or sweeping.
//!
//! Random lines show nothing here: methods that lose a third of these have no fault in
//! 30,000 random ones.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DAffine3, DMat3, DVec3, dvec3};

use super::{ALL, Chain, Event, IndexedMesh, Line, Shape, Sink, Stage};
use crate::mesh::Mesh;
use crate::ray::{Ray, Sense};
use crate::support::dice::Dice;
use crate::support::{aim, meshes};

/// A mesh in its place.
struct Case {
    name: &'static str,
    mesh: Arc<Mesh>,
    map: DAffine3,
    shape: Shape,
    stage: Stage,
}

impl Case {
    fn new(name: &'static str, mesh: Mesh) -> Self {
        Self::mapped(name, mesh, DAffine3::IDENTITY)
    }

    fn mapped(name: &'static str, mesh: Mesh, map: DAffine3) -> Self {
        let mesh = Arc::new(mesh);
        let indexed = Arc::new(IndexedMesh::new(mesh.clone()));
        let placed = Shape::place_mesh(indexed, &Chain::NOTHING.then(&map))
            .expect("a regular map");
        Self { name, mesh, map, shape: placed.shape, stage: Stage::new(placed.bounds) }
    }

    /// The crossings with the line of a ray, unsorted, and the line.
    fn crossings(&self, ray: &Ray, events: &mut Vec<Event>) -> Option<Line> {
        events.clear();
        let line = Line::new(ray, &self.stage)?;
        self.shape.crossings(ALL, &line, &mut Sink { events, leaf: 0 });
        Some(line)
    }

    /// A unit in the last place of the largest coordinate at hand, as a step along a line:
    /// that of the corners and the line's origin in the mesh's own frame.
    fn unit(&self, line: &Line) -> f64 {
        let back = self.map.inverse();
        let (origin, dir) =
            (back.transform_point3(line.origin), back.transform_vector3(line.dir));
        let bounds = self.mesh.bounds();
        let reach = bounds.min.abs().max(bounds.max.abs()).max(origin.abs());
        f64::EPSILON * reach.max_element() / dir.abs().max_element()
    }
}

fn far() -> DAffine3 {
    DAffine3::from_translation(dvec3(148_376.0, 1234.0, -223_423.0))
}

fn sheared() -> DAffine3 {
    DAffine3::from_mat3_translation(
        DMat3::from_cols(
            dvec3(-1.0, 0.3, 0.0),
            dvec3(0.2, 0.7, 0.1),
            dvec3(0.0, 0.4, 1.3),
        ),
        dvec3(0.1, -0.2, 0.3),
    )
}

fn ordinary() -> Vec<Case> {
    let ball = || meshes::icosphere(3);
    let grid = |steps| meshes::grid_box(-DVec3::ONE, DVec3::ONE, steps);
    vec![
        Case::new("icosphere", ball()),
        Case::new("jittered icosphere", meshes::jittered(&ball(), 0.1, 1)),
        Case::new("uv sphere", meshes::uv_sphere(48, 24)),
        Case::new("lattice cube", grid(8)),
        Case::new("far icosphere", meshes::mapped(&ball(), &far())),
        Case::mapped("icosphere moved far", ball(), far()),
        Case::mapped("mirrored and sheared icosphere", ball(), sheared()),
        Case::mapped("mirrored and sheared grid", grid(3), sheared()),
    ]
}

/// Meshes that are closed by their numbers and otherwise as bad as they can be.
fn bad() -> Vec<Case> {
    let small = |size: f64| {
        meshes::mapped(&meshes::icosphere(2), &DAffine3::from_scale(DVec3::splat(size)))
    };
    vec![
        Case::new("needle 1:1e8", meshes::needle(1e8)),
        Case::new("needle 1:1e-8", meshes::needle(1e-8)),
        Case::new("faces of 1e-20", small(1e-10)),
        Case::new("slivers of 1e-20", meshes::with_slivers(&meshes::icosphere(2), 5e-10)),
        Case::new("corners doubled", meshes::with_slivers(&meshes::icosphere(2), 0.0)),
        Case::new("cubes with one corner", meshes::touching_cubes(1)),
        Case::new("cubes with one edge", meshes::touching_cubes(2)),
        Case::new("cubes with one face", meshes::stacked_cubes()),
        Case::mapped("needle, sheared", meshes::needle(1e8), sheared()),
    ]
}

/// Aims lines at all cases, each on a thread of its own. Says how many crossings there
/// were, and fails if any line goes in more or less often than it comes out.
fn assert_balanced(cases: &[Case], lines: usize, seed: u64) {
    let crossed = AtomicU64::new(0);
    std::thread::scope(|scope| {
        for case in cases {
            scope.spawn(|| {
                let (mut dice, mut events) = (Dice::new(seed), Vec::new());
                let mut hits = 0;
                for i in 0..lines {
                    let ray = aim::at_feature(&case.mesh, &mut dice, i);
                    let ray = aim::mapped(&ray, &case.map);
                    if case.crossings(&ray, &mut events).is_none() {
                        continue;
                    }
                    let entered =
                        events.iter().filter(|e| e.sense == Sense::Enter).count();
                    let name = case.name;
                    assert_eq!(events.len() % 2, 0, "{name}: odd: {ray:?}");
                    assert_eq!(2 * entered, events.len(), "{name}: unbalanced: {ray:?}");
                    assert!(events.iter().all(|e| e.t.is_finite()), "{name}: {ray:?}");
                    hits += u64::from(!events.is_empty());
                }
                assert!(hits > lines as u64 / 5, "{}: only {hits} hits", case.name);
                crossed.fetch_add(hits, Ordering::Relaxed);
            });
        }
    });
    assert!(crossed.into_inner() > (cases.len() * lines / 3) as u64);
}

#[test]
fn n16_a_million_lines_at_features_have_even_balanced_lists() {
    assert_balanced(&ordinary(), 125_000, 16);
}

#[test]
fn n20_needles_slivers_doubled_corners_and_touching_cubes_have_even_balanced_lists() {
    assert_balanced(&bad(), 20_000, 20);
}

/// Winding numbers leave {0, 1} only where crossings of neighbouring faces have changed
/// places by rounding.
#[test]
fn n17_windings_are_0_or_1_but_for_4_ulp() {
    let mut events = Vec::new();
    for case in ordinary() {
        let mut dice = Dice::new(17);
        for i in 0..20_000 {
            let ray = aim::at_feature(&case.mesh, &mut dice, i);
            let ray = aim::mapped(&ray, &case.map);
            let Some(line) = case.crossings(&ray, &mut events) else { continue };
            let unit = case.unit(&line);
            events.sort_by(|a, b| a.t.total_cmp(&b.t));
            let (mut winding, mut from) = (0, f64::NEG_INFINITY);
            for event in &events {
                // A wrong stretch ends where the number is right again, not at each event.
                let length = (event.t - from) / unit;
                assert!(
                    (0..=1).contains(&winding) || length <= 4.0,
                    "{}: {length} ulp of {winding}: {ray:?}",
                    case.name
                );
                if (0..=1).contains(&winding) {
                    from = event.t;
                }
                winding += if event.sense == Sense::Enter { 1 } else { -1 };
            }
            assert_eq!(winding, 0);
        }
    }
}
