//! Cases that can be checked with pencil and paper.

#[expect(dead_code, reason = "paper examples need no random models")]
mod support;

use glam::{DVec3, dvec3};
use solidray::{Op, Ray, Sense, Solid};
use support::{along_x, ends, scene, spans};

const Z: DVec3 = DVec3::Z;

fn cube(size: f64) -> Solid {
    Solid::cuboid(DVec3::splat(size))
}

#[test]
fn a_ball_is_crossed_at_its_poles() {
    assert_eq!(ends(&Solid::ball(2.0), &along_x(0.0, 0.0)), [[8.0, 12.0]]);
    assert_eq!(ends(&Solid::ball(5.0), &along_x(3.0, 0.0)), [[6.0, 14.0]]);
    assert_eq!(ends(&Solid::ball(5.0), &along_x(0.0, 5.5)), [] as [[f64; 2]; 0]);
}

#[test]
fn t_counts_multiples_of_the_direction() {
    let ray = Ray::new(dvec3(-10.0, 0.0, 0.0), dvec3(4.0, 0.0, 0.0));
    assert_eq!(ends(&Solid::ball(2.0), &ray), [[2.0, 3.0]]);
}

#[test]
fn a_tangent_makes_no_span() {
    assert!(ends(&Solid::ball(2.0), &along_x(2.0, 0.0)).is_empty());
    let standing = Solid::cylinder(2.0, 5.0);
    assert!(ends(&standing, &along_x(2.0, 1.0)).is_empty());
}

#[test]
fn a_line_that_touches_an_edge_makes_no_span() {
    let edge = dvec3(-1.0, 1.0, 0.25);
    for dir in [dvec3(3.0, 4.0, 0.0), dvec3(1.0, 3.0, 0.125)] {
        for steps in (-40..40).map(f64::from) {
            let ray = Ray::new(edge + steps * dir, dir);
            let beside = ray.at(-steps) - edge;
            assert!(
                beside != DVec3::ZERO || ends(&cube(2.0), &ray).is_empty(),
                "{ray:?}"
            );
        }
    }
}

#[test]
fn maps_apply_from_the_inside_out() {
    let bar = Solid::cuboid(dvec3(4.0, 2.0, 2.0));
    let quarter = std::f64::consts::FRAC_PI_2;
    let turned_then_moved =
        bar.clone().rotated(Z, quarter).translated(dvec3(10.0, 0.0, 0.0));
    let moved_then_turned = bar.translated(dvec3(10.0, 0.0, 0.0)).rotated(Z, quarter);
    let b = scene(&turned_then_moved).bounds();
    assert!((b.min - dvec3(9.0, -2.0, -1.0)).length() < 1e-12, "{b:?}");
    let b = scene(&moved_then_turned).bounds();
    assert!((b.min - dvec3(-1.0, 8.0, -1.0)).length() < 1e-12, "{b:?}");
}

#[test]
fn operators_do_what_they_say() {
    let (a, b) = (cube(2.0), cube(2.0).translated(dvec3(1.0, 0.0, 0.0)));
    let ray = along_x(0.25, 0.5);
    assert_eq!(ends(&(a.clone() + b.clone()), &ray), [[9.0, 12.0]]);
    assert_eq!(ends(&(a.clone() & b.clone()), &ray), [[10.0, 11.0]]);
    assert_eq!(ends(&(a.clone() - b.clone()), &ray), [[9.0, 10.0]]);
    assert_eq!(ends(&(b - a), &ray), [[11.0, 12.0]]);
}

#[test]
fn a_hole_makes_two_spans() {
    let tube = Solid::cylinder(3.0, 2.0) - Solid::cylinder(1.0, 4.0).translated(-Z);
    assert_eq!(ends(&tube, &along_x(0.0, 1.0)), [[7.0, 9.0], [11.0, 13.0]]);
}

#[test]
fn nested_differences_give_back() {
    let onion = cube(6.0) - (cube(4.0) - cube(2.0));
    assert_eq!(ends(&onion, &along_x(0.0, 0.0)), [[7.0, 8.0], [9.0, 11.0], [12.0, 13.0]]);
}

#[test]
fn shared_faces_join_and_vanish() {
    let (a, b) = (cube(2.0), cube(2.0).translated(dvec3(2.0, 0.0, 0.0)));
    let ray = Ray::new(dvec3(-10.0, 0.1, 0.3), dvec3(1.0, 0.01, -0.02));
    assert_eq!(ends(&(a.clone() + b.clone()), &ray).len(), 1, "abutting boxes are one");
    assert!(ends(&(a.clone() & b.clone()), &ray).is_empty(), "a shared face is no solid");
    assert!(ends(&(a.clone() - a.clone()), &ray).is_empty());
    assert_eq!(
        ends(&(a.clone() - b), &ray),
        ends(&a, &ray),
        "a flush cut leaves no film"
    );
}

#[test]
fn a_gap_too_thin_for_t_is_closed() {
    let slot = Solid::cuboid_between(-DVec3::ONE, dvec3(1e-9, 2.0, 2.0))
        .translated(dvec3(1.0, 0.0, 0.0));
    let slotted = cube(4.0) - slot.clone() + (slot & cube(2.0));
    let far = 2.0_f64.powi(30);
    let ray = |origin: f64| Ray::new(dvec3(origin, 0.0, 0.0), DVec3::X);
    assert_eq!(ends(&slotted, &ray(-2.0)).len(), 2);
    assert_eq!(ends(&slotted, &ray(-far)), [[far - 2.0, far + 2.0]]);
}

#[test]
fn no_operand_no_solid() {
    let ray = along_x(0.0, 0.0);
    for op in [Op::Union, Op::Intersection, Op::Difference] {
        assert!(ends(&Solid::boolean(op, []), &ray).is_empty(), "{op:?}");
        assert_eq!(ends(&Solid::boolean(op, [cube(2.0)]), &ray), [[9.0, 11.0]], "{op:?}");
    }
    let empty = Solid::empty;
    assert!(ends(&(empty() - cube(1.0)), &ray).is_empty());
    assert!(ends(&(empty() & cube(1.0)), &ray).is_empty());
    assert_eq!(ends(&(cube(2.0) - empty()), &ray), [[9.0, 11.0]]);
    assert_eq!(ends(&(cube(2.0) - (empty() & cube(1.0))), &ray), [[9.0, 11.0]]);
}

#[test]
fn two_sheets_and_one_sheet() {
    let up = Ray::new(dvec3(0.0, 0.0, -10.0), Z);
    let two = Solid::hyperboloid_of_two_sheets(1.0, 1.0, 6.0);
    assert_eq!(ends(&two, &up), [[7.0, 9.0], [11.0, 13.0]]);
    let one = Solid::hyperboloid_of_one_sheet(1.0, 2.0, 6.0);
    assert_eq!(ends(&one, &along_x(0.0, 0.0)), [[9.0, 11.0]]);
    let at_the_rim = ends(&one, &along_x(0.0, 3.0 - 1e-9));
    assert!((at_the_rim[0][0] - 8.0).abs() < 1e-8, "{at_the_rim:?}");
    // Steeper than the waist and between the ends the line leaves and comes back.
    let oblique = Ray::new(dvec3(1.2, 0.0, 0.0), dvec3(0.0, 0.4, 1.0));
    assert_eq!(ends(&one, &oblique).len(), 2);
}

#[test]
fn a_paraboloid_is_as_wide_as_it_says() {
    let bowl = Solid::paraboloid(2.0, 4.0);
    assert_eq!(ends(&bowl, &along_x(0.0, 1.0)), [[9.0, 11.0]]);
    let down = Ray::new(dvec3(1.0, 0.0, 10.0), -Z);
    assert_eq!(ends(&bowl, &down), [[6.0, 9.0]]);
}

#[test]
fn cones_have_an_apex() {
    let cone = Solid::frustum(2.0, 0.0, 4.0);
    assert_eq!(ends(&cone, &along_x(0.0, 2.0)), [[9.0, 11.0]]);
    assert_eq!(ends(&cone, &Ray::new(dvec3(0.0, 0.0, -1.0), Z)), [[1.0, 5.0]]);
    assert!(ends(&cone, &along_x(0.0, 4.0)).is_empty(), "through the apex, level");
}

#[test]
fn half_spaces_cut() {
    let half = Solid::half_space(dvec3(2.0, 0.0, 0.0), 1.0);
    assert_eq!(ends(&(cube(2.0) & half.clone()), &along_x(0.0, 0.0)), [[9.0, 10.5]]);
    assert_eq!(ends(&(cube(2.0) - half.clone()), &along_x(0.0, 0.0)), [[10.5, 11.0]]);
    let turned = cube(2.0) & half.rotated(Z, 0.3);
    assert_eq!(ends(&turned, &along_x(0.0, 0.0)).len(), 1);
}

#[test]
fn mirrored_and_sheared_solids_are_solids() {
    let shear =
        glam::DAffine3::from_cols(DVec3::X, dvec3(1.0, 1.0, 0.0), DVec3::Z, DVec3::ZERO);
    let leaning = cube(2.0).mapped(shear);
    assert_eq!(ends(&leaning, &along_x(0.5, 0.0)), [[9.5, 11.5]]);
    let mirrored = Solid::cylinder(1.0, 3.0).mirrored(Z);
    let up = Ray::new(dvec3(0.0, 0.0, -10.0), Z);
    assert_eq!(ends(&mirrored, &up), [[7.0, 10.0]]);
}

#[test]
fn normals_point_outward() {
    let tube = Solid::cylinder(3.0, 2.0) - Solid::cylinder(1.0, 4.0).translated(-Z);
    let scene = scene(&tube);
    let ray = along_x(0.0, 1.0);
    let list = spans(&scene, &ray);
    let normals: Vec<DVec3> = list
        .iter()
        .flat_map(|s| [s.enter, s.exit])
        .map(|c| scene.normal_at(&ray, &c))
        .collect();
    assert_eq!(normals, [-DVec3::X, DVec3::X, -DVec3::X, DVec3::X]);
    assert_eq!(list[0].exit.leaf, 1, "the hole owns its wall");
}

#[test]
fn a_shared_face_belongs_to_the_first_leaf_that_makes_it() {
    let owner = |solid: &Solid| spans(&scene(solid), &along_x(0.25, 0.5))[0].enter.leaf;
    let (a, b) = (cube(2.0), cube(2.0).scaled(dvec3(1.0, 2.0, 2.0)));
    assert_eq!(owner(&(a.clone() + b.clone())), 0);
    assert_eq!(owner(&(a.clone() & b.clone())), 0, "both are needed");
    let aside = cube(1.0).translated(dvec3(0.9, 0.0, 0.5));
    assert_eq!(owner(&((a & aside) + b)), 2, "the first is in a part that is not there");
}

#[test]
fn first_hit_starts_at_the_origin() {
    let scene = scene(&cube(2.0));
    let mut tracer = scene.tracer();
    let hit = |t: f64| Ray::new(dvec3(t, 0.0, 0.0), DVec3::X);
    let first = tracer.first_hit(&hit(-5.0)).map(|c| (c.t, c.sense, c.face));
    assert_eq!(first, Some((4.0, Sense::Enter, 0)));
    let first = tracer.first_hit(&hit(0.0)).map(|c| (c.t, c.sense, c.face));
    assert_eq!(first, Some((1.0, Sense::Exit, 1)));
    assert_eq!(tracer.first_hit(&hit(5.0)), None);
}

#[test]
fn n13_rays_that_are_no_rays_meet_nothing() {
    for ray in [
        Ray::new(DVec3::ZERO, DVec3::ZERO),
        Ray::new(DVec3::NAN, DVec3::X),
        Ray::new(DVec3::ZERO, dvec3(f64::INFINITY, 0.0, 0.0)),
    ] {
        assert!(ends(&cube(2.0), &ray).is_empty());
    }
}

#[test]
fn errors_name_the_leaf() {
    let error = |solid: &Solid| {
        solidray::Scene::compile(solid).expect_err("this solid is wrong").to_string()
    };
    let flat = cube(1.0) + Solid::ball(1.0).named("lid").scaled(dvec3(1.0, 1.0, 0.0));
    insta::assert_snapshot!(
        "compile_errors",
        [
            error(&Solid::ball(-1.0)),
            error(&(cube(1.0) - Solid::cylinder(1.0, f64::NAN))),
            error(&Solid::frustum(0.0, 0.0, 1.0)),
            error(&Solid::hyperboloid_of_one_sheet(2.0, 1.0, 1.0)),
            error(&flat),
            error(&Solid::half_space(Z, 0.0)),
            error(&(Solid::half_space(Z, 0.0) - cube(1.0))),
            error(
                &cube(1.0)
                    .placed(solidray::Place { line: 3, column: 7 })
                    .scaled(DVec3::ZERO)
            ),
        ]
        .join("\n")
    );
}

#[test]
fn sizes_whose_squares_are_no_numbers_are_refused() {
    for radius in [1e160, 1e-160] {
        assert!(solidray::Scene::compile(&Solid::ball(radius)).is_err(), "{radius}");
    }
}

#[test]
fn bounds_end_where_a_box_cuts_straight_across() {
    let half = Solid::cuboid_between(dvec3(1.0, -9.0, -9.0), DVec3::splat(9.0));
    let corner = Solid::cuboid_between(dvec3(-9.0, 0.5, 0.5), DVec3::splat(9.0));
    let solid = cube(6.0) - half.clone() - corner.clone();
    let bounds = scene(&solid).bounds();
    assert_eq!((bounds.min, bounds.max), (DVec3::splat(-3.0), dvec3(1.0, 3.0, 3.0)));
    // One cut makes way for another, and lines beside what is left find what cut it.
    let low = Solid::cuboid_between(DVec3::splat(-9.0), dvec3(9.0, 9.0, 0.5));
    let bounds = scene(&(solid.clone() - low.clone())).bounds();
    assert_eq!((bounds.min, bounds.max), (dvec3(-3.0, -3.0, 0.5), dvec3(1.0, 0.5, 3.0)));
    for y in [-2.0, 0.2, 1.0, 2.5] {
        for z in [-2.0, 0.2, 0.7, 2.5] {
            for (dir, from) in [
                (DVec3::X, dvec3(-10.0, y, z)),
                (Z, dvec3(y, z, -10.0)),
                (DVec3::Y, dvec3(z, -10.0, y)),
            ] {
                let ray = Ray::new(from, dir + 0.3 * dvec3(0.1, 0.2, 0.3));
                let all = ends(&(solid.clone() - low.clone()), &ray);
                let kept = solid.clone() & Solid::half_space(-Z, -0.5);
                assert_eq!(all.len(), ends(&kept, &ray).len(), "{ray:?}");
            }
        }
    }
    assert!(
        scene(&(cube(1.0) - half.translated(DVec3::splat(-4.0)))).bounds().is_empty()
    );
}

/// A line that comes out of the bounds through one cut and goes on into what the other has
/// taken away, past the part of that one which borders on the bounds.
#[test]
fn what_cuts_the_bounds_is_found_by_lines_beside_them() {
    let block = Solid::cuboid_between(DVec3::ZERO, DVec3::splat(10.0));
    let right = Solid::cuboid_between(dvec3(5.0, -1.0, -1.0), DVec3::splat(11.0));
    let top = Solid::cuboid_between(dvec3(-1.0, 4.0, -1.0), dvec3(5.0, 11.0, 11.0));
    // Enough leaves beside the cut that not all of them are asked about every line.
    let dots = (0..40).map(|i| {
        Solid::ball(0.05).translated(dvec3(
            4.9,
            0.5 + 0.7 * f64::from(i % 5),
            1.0 + f64::from(i / 5),
        ))
    });
    let solid = dots.fold(block - right - top, |solid, dot| solid - dot);
    let bounds = scene(&solid).bounds();
    assert_eq!((bounds.min, bounds.max), (DVec3::ZERO, dvec3(5.0, 4.0, 10.0)));
    let ray = Ray::new(dvec3(2.0, 0.0, 5.0), dvec3(0.5, 1.0, 0.0));
    assert_eq!(ends(&solid, &ray), [[0.0, 4.0]]);
}
