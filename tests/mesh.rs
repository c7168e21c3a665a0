//! Meshes: what may not change their spans, points far from the origin, what is refused,
//! and volumes.

#[expect(dead_code, reason = "meshes are made and not drawn by lot here")]
mod support;

use glam::{DAffine3, DVec3, dvec3};
use robust::{Coord, Coord3D, orient2d, orient3d};
use solidray::measure::{self, Sampling};
use solidray::render::{self, Camera, Projection};
use solidray::{Mesh, MeshError, OpenEdge, Ray, Scene, Solid, Span};
use support::aim::{self, at_feature};
use support::dice::Dice;
use support::nearness::{disagreement, distance_to};
use support::{meshes, scene};

/// Meshes whose edges have numbers for their middles.
fn on_a_lattice() -> Vec<Mesh> {
    vec![
        meshes::tetrahedron(),
        meshes::octahedron(),
        meshes::grid_box(-DVec3::ONE, DVec3::ONE, 4),
        meshes::rounded(&meshes::icosphere(2)),
        meshes::rounded(&meshes::jittered(&meshes::icosphere(2), 0.1, 18)),
        meshes::touching_cubes(2),
    ]
}

fn spans(scene: &Scene, ray: &Ray) -> Vec<Span> {
    scene.tracer().spans(ray).to_vec()
}

fn places(spans: &[Span]) -> Vec<[f64; 2]> {
    spans.iter().map(|span| [span.enter.t, span.exit.t]).collect()
}

/// What only one of two answers covers is shorter than 4 ulp, or within 4 ulp of the surface:
/// so are rays within faces and along edges.
#[test]
fn n18_cutting_faces_into_four_changes_spans_by_4_ulp_at_most() {
    for mesh in on_a_lattice() {
        let finer = meshes::quartered(&mesh);
        let scenes = [&mesh, &finer].map(|m| scene(&Solid::mesh(m.clone())));
        let mut dice = Dice::new(18);
        for i in 0..10_000 {
            let ray = at_feature([&mesh, &finer][i % 2], &mut dice, i / 2);
            let [a, b] = [0, 1].map(|k| spans(&scenes[k], &ray));
            let apart = disagreement(&mesh, &ray, &a, &b);
            assert!(apart <= 4.0, "{i}: {apart} ulp: {ray:?}: {a:?}, {b:?}");
        }
    }
}

/// A face that is almost parallel to the ray is seen as a sliver.
#[test]
fn spans_of_rays_within_faces_end_on_the_surface() {
    for mesh in [meshes::tetrahedron(), meshes::jittered(&meshes::icosphere(1), 0.1, 6)] {
        let scene = scene(&Solid::mesh(mesh.clone()));
        let mut dice = Dice::new(6);
        for _ in 0..20_000 {
            let ray = at_feature(&mesh, &mut dice, aim::WITHIN_A_FACE);
            for t in places(&spans(&scene, &ray)).concat() {
                let off = distance_to(&mesh, ray.at(t));
                assert!(off < 1e-14, "{off} at {t} of {ray:?}");
            }
        }
    }
}

#[test]
fn n19_the_order_of_points_faces_and_corners_changes_no_bit() {
    let jittered = meshes::jittered(&meshes::icosphere(3), 0.1, 19);
    let far = DAffine3::from_translation(dvec3(148_376.0, 1234.0, -223_423.0));
    let mut all = on_a_lattice();
    all.extend([meshes::mapped(&jittered, &far), jittered, meshes::uv_sphere(24, 12)]);
    for (seed, mesh) in (0..).zip(all) {
        let shuffled = meshes::shuffled(&mesh, seed);
        let scenes = [&mesh, &shuffled].map(|m| scene(&Solid::mesh(m.clone())));
        let mut dice = Dice::new(seed);
        for i in 0..5_000 {
            let ray = at_feature(&mesh, &mut dice, i);
            let [a, b] = [0, 1].map(|k| places(&spans(&scenes[k], &ray)));
            assert_eq!(a, b, "{i}: {ray:?}");
        }
    }
}

fn coord(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}

/// How often a mesh winds around a point, counted by the faces straight above it with exact
/// signs. The point is above or below no corner.
fn winding(mesh: &Mesh, p: DVec3) -> i32 {
    let flat = |p: DVec3| Coord { x: p.x, y: p.y };
    let corners = |face: &[u32; 3]| face.map(|i| mesh.points()[i as usize]);
    let above = |[a, b, c]: [DVec3; 3]| {
        let sides = [(a, b), (b, c), (c, a)]
            .map(|(from, to)| orient2d(flat(from), flat(to), flat(p)));
        assert!(sides.iter().all(|&side| side != 0.0), "{p} is in line with an edge");
        let sense = i32::from(sides[0] > 0.0) * 2 - 1;
        let is_crossed = sides.iter().all(|side| (*side > 0.0) == (sides[0] > 0.0));
        // Positive below a triangle that is counter-clockwise seen from above.
        let side = orient3d(coord(a), coord(b), coord(c), coord(p));
        if is_crossed && f64::from(sense) * side > 0.0 { sense } else { 0 }
    };
    mesh.faces().iter().map(corners).map(above).sum()
}

/// A solid of radius 1 a million radii away. Half of the points are as close to its surface
/// as is asked, where coordinates have steps of a tenth of that.
#[test]
fn n21_points_of_a_mesh_a_million_radii_away_are_told_apart() {
    const CLOSE: f64 = 1e-9;
    let offset = DAffine3::from_translation(dvec3(1e6, -1e6, 1e6));
    let mesh = meshes::jittered(&meshes::icosphere(2), 0.1, 21);
    let mesh = meshes::mapped(&mesh, &offset);
    let scene = scene(&Solid::mesh(mesh.clone()));
    let (mut tracer, mut dice) = (scene.tracer(), Dice::new(21));
    let (mut asked, mut inside, mut close) = (0, 0, 0);
    while asked < 100_000 {
        let point = if asked % 2 == 0 {
            offset.transform_point3(dice.point(1.2))
        } else {
            let face = mesh.faces()[dice.below(mesh.faces().len())];
            let [a, b, c] = face.map(|i| mesh.points()[i as usize]);
            let on =
                a + dice.within(0.0, 0.5) * (b - a) + dice.within(0.0, 0.5) * (c - a);
            let depth = 10.0_f64.powf(dice.within(-9.0, -6.0));
            let normal = (b - a).cross(c - a).normalize();
            on + if dice.below(2) == 0 { depth } else { -depth } * normal
        };
        let least = distance_to(&mesh, point);
        if least <= CLOSE {
            continue;
        }
        let is_inside = winding(&mesh, point) > 0;
        assert_eq!(
            tracer.contains(point),
            is_inside,
            "{point}, {least} from the surface"
        );
        asked += 1;
        inside += usize::from(is_inside);
        close += usize::from(least < 10.0 * CLOSE);
    }
    assert!((30_000..70_000).contains(&inside) && close > 10_000, "{inside}, {close}");
}

#[test]
fn n22_what_bounds_no_solid_is_refused_by_name() {
    let points = || vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let faces = || vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    assert!(Mesh::new(points(), faces()).is_ok());
    let edge = |a: u32, b: u32, excess| OpenEdge {
        points: [a, b],
        ends: [a, b].map(|i| points()[i as usize]),
        excess,
    };

    let open = Mesh::new(points(), faces()[..3].to_vec()).expect_err("a face is missing");
    let first = vec![edge(0, 2, 1), edge(3, 0, 1), edge(2, 3, 1)];
    assert_eq!(open, MeshError::OpenEdges { count: 3, first });
    assert_eq!(
        open.to_string(),
        "the mesh is not closed and oriented: 3 edges without the neighbour that runs the \
         other way, first 0–2 from (0, 0, 0) to (0, 1, 0); 3–0 from (0, 0, 1) to (0, 0, 0); \
         2–3 from (0, 1, 0) to (0, 0, 1)"
    );

    let mut flipped = faces();
    flipped[3] = [0, 2, 3];
    let flipped = Mesh::new(points(), flipped).expect_err("a face is flipped");
    let first = vec![edge(0, 2, 2), edge(3, 0, 2), edge(2, 3, 2)];
    assert_eq!(flipped, MeshError::OpenEdges { count: 3, first });
    assert!(flipped.to_string().contains("0–2 from (0, 0, 0) to (0, 1, 0) (2×)"));

    let mut turned = faces();
    turned.iter_mut().for_each(|face| face.swap(0, 1));
    let error = Mesh::new(points(), turned).expect_err("all faces are flipped");
    assert_eq!(error, MeshError::InsideOut { volume: -1.0 / 6.0 });

    for bad in [f64::NAN, f64::INFINITY] {
        let mut points = points();
        points[2].y = bad;
        let error = Mesh::new(points, faces()).expect_err("a point is nowhere");
        assert!(matches!(error, MeshError::NotFinite { index: 2, .. }), "{error}");
        let text = format!("point 2 is not finite: (0, {bad}, 0)");
        assert_eq!(error.to_string(), text);
    }

    let mut beyond = faces();
    beyond[1][2] = 4;
    let error = Mesh::new(points(), beyond).expect_err("a point is missing");
    assert_eq!(error, MeshError::NoSuchPoint { face: 1, index: 4, count: 4 });
    assert_eq!(error.to_string(), "face 1 names point 4, but there are 4 points");
    assert_eq!(Mesh::new(points(), vec![]), Err(MeshError::NoFaces));
}

/// A 95 % interval widened to one of 99 %: Student's t with 15 degrees of freedom, 2.947
/// against 2.131.
const TO_99: f64 = 1.383;

#[test]
fn n23_volumes_by_rays_are_those_by_the_divergence_theorem() {
    let ball = meshes::icosphere(3);
    let cases = [
        ("tetrahedron", meshes::tetrahedron()),
        ("octahedron", meshes::octahedron()),
        ("prism", meshes::prism(7)),
        ("box", meshes::grid_box(-DVec3::ONE, dvec3(1.0, 2.0, 0.5), 3)),
        ("jittered ball", meshes::jittered(&ball, 0.1, 23)),
        ("uv sphere", meshes::uv_sphere(24, 12)),
        ("cubes with one edge", meshes::touching_cubes(2)),
        ("needle", meshes::needle(1e4)),
        ("ball", ball),
    ];
    let (mut checks, mut failures) = (0, Vec::new());
    for (name, mesh) in cases {
        let exact = mesh.volume();
        let scene = scene(&Solid::mesh(mesh));
        for seed in 0..10 {
            let sampling = Sampling { seed, rel_tol: 1e-3, ..Sampling::default() };
            let volume = measure::volume(&scene, &sampling);
            checks += 1;
            if (volume.value - exact).abs() > TO_99 * volume.half_width() {
                failures.push(format!("{name}, seed {seed}: {volume:?}, exact {exact}"));
            }
        }
    }
    assert!(failures.len() <= checks / 30, "{failures:#?}");
}

/// Blocks of rays look at faces together: lattices of rays through corners and along edges,
/// rays that run apart or not, from outside and inside, tiles that are not full.
#[test]
fn pictures_of_meshes_show_what_single_rays_meet() {
    let ball = meshes::icosphere(3);
    let cut = |mesh: &Mesh| {
        Solid::mesh(mesh.clone()) - Solid::ball(0.5).translated(dvec3(0.4, 0.5, 0.6))
    };
    let far = DAffine3::from_translation(dvec3(148_376.0, 1234.0, -223_423.0));
    let turned = DAffine3::from_axis_angle(DVec3::ONE.normalize(), 0.7)
        * DAffine3::from_scale(dvec3(1.0, -0.3, 2.0));
    let mut solids: Vec<Solid> = on_a_lattice().into_iter().map(Solid::mesh).collect();
    solids.extend([
        cut(&meshes::jittered(&ball, 0.1, 3)),
        Solid::ball(0.9) - Solid::mesh(ball.clone()).scaled(dvec3(2.0, 0.4, 0.4)),
        Solid::mesh(meshes::icosphere(5))
            - Solid::mesh(ball.clone()).scaled(DVec3::splat(0.99)),
        Solid::mesh(meshes::mapped(&ball, &far)),
        Solid::mesh(ball.clone()).mapped(far),
        Solid::mesh(ball).mapped(turned),
        Solid::mesh(meshes::needle(1e8)),
        Solid::mesh(meshes::with_slivers(&meshes::icosphere(2), 5e-10)),
    ]);
    let mut hits = 0;
    for (i, solid) in solids.into_iter().enumerate() {
        let scene = scene(&solid);
        let (center, size) = (scene.bounds().center(), scene.bounds().size());
        for (from, step) in [
            (DVec3::Z, 4.0),
            (dvec3(1.0, 1.0, 0.0), 2.0),
            (dvec3(0.3, -0.7, 0.2), 0.9),
            (dvec3(0.2, 0.1, 0.4), 0.3),
        ] {
            let eye = center + step * size.max_element() * from;
            let camera = [eye.x, eye.y, eye.z, center.x, center.y, center.z];
            for projection in [Projection::Orthographic, Projection::Perspective] {
                let camera =
                    Camera::vector(camera).expect("an eye").with_projection(projection);
                let view = camera.view([65, 40], &scene.bounds());
                let frame = render::trace(&scene, &view, [0.5, 0.5], &|_| {});
                let mut tracer = scene.tracer();
                for (x, y) in (0..40).flat_map(|y| (0..65).map(move |x| (x, y))) {
                    let hit = tracer.first_hit(&frame.ray(x, y));
                    let place = format!("{i}, {from}, {projection:?}, ({x}, {y})");
                    assert_eq!(frame.hit(x, y), hit, "{place}");
                    hits += u32::from(hit.is_some());
                }
            }
        }
    }
    assert!(hits > 60_000, "only {hits} hits");
}
