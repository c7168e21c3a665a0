//! Surfaces that six printed digits have moved apart, and the weld that joins them.

#[expect(dead_code, reason = "these solids are printed and read")]
mod support;

use std::path::Path;

use glam::{DAffine3, DMat3, DQuat, DVec3, dvec3};
use solidray::read::{self, Format, ReadOptions};
use solidray::{CompileError, CompileOptions, Ray, Scene, Solid, Weld};
use support::dice::Dice;
use support::{ends_in, scene};

fn welding(weld: f64) -> CompileOptions {
    CompileOptions { weld, ..CompileOptions::default() }
}

fn welded(solid: &Solid, weld: f64) -> Scene {
    Scene::compile_with(solid, &welding(weld)).expect("the weld is fine")
}

fn refused(solid: &Solid, weld: f64) -> CompileError {
    Scene::compile_with(solid, &welding(weld)).expect_err("the weld is too large")
}

/// The weld that is suggested for a solid.
fn suggested(solid: &Solid) -> Option<f64> {
    let found = Scene::near_misses(solid, &CompileOptions::default());
    found.expect("the test's solid is right").weld
}

/// A number with six significant digits at most, as OpenSCAD prints it.
fn printed(x: f64) -> String {
    let short: f64 = format!("{x:.5e}").parse().expect("a number was printed");
    format!("{short}")
}

/// A map and what it is applied to, in OpenSCAD's words.
fn multmatrix(map: &DAffine3, inner: &str) -> String {
    let m = map.matrix3.transpose();
    let rows = [m.x_axis, m.y_axis, m.z_axis];
    let rows: Vec<String> = (0..3)
        .map(|i| {
            let row = rows[i].to_array().into_iter().chain([map.translation[i]]);
            format!("[{}]", row.map(printed).collect::<Vec<_>>().join(", "))
        })
        .collect();
    format!("multmatrix([{}, [0, 0, 0, 1]]) {{ {inner} }}", rows.join(", "))
}

fn cube(size: DVec3) -> String {
    let [x, y, z] = size.to_array().map(printed);
    format!("cube(size = [{x}, {y}, {z}], center = false);")
}

fn parsed(text: &str) -> Solid {
    let options = ReadOptions::default();
    let model = read::bytes(text.as_bytes(), Path::new("text"), Format::Csg, &options);
    model.expect("the text is right").solid
}

/// A ray from a local one.
fn mapped(origin: DVec3, dir: DVec3, map: &DAffine3) -> Ray {
    Ray::new(map.transform_point3(origin), map.transform_vector3(dir))
}

fn counted(scene: &Scene, ray: &Ray) -> usize {
    ends_in(scene, ray).len()
}

/// Two boxes side by side under one turn, each by a matrix of its own.
fn abutting(turn: &DAffine3, dice: &mut Dice) -> (Solid, Vec<Ray>) {
    let wide = dice.within(0.5, 30.0);
    let size = dvec3(wide, 10.0, 10.0);
    let beside = *turn * DAffine3::from_translation(dvec3(wide, 0.0, 0.0));
    let text = multmatrix(turn, &cube(size)) + &multmatrix(&beside, &cube(size));
    let rays = (0..8)
        .map(|_| {
            let through = dvec3(wide, dice.within(0.5, 9.5), dice.within(0.5, 9.5));
            let dir = DVec3::X + 0.02 * dice.direction();
            mapped(through - 50.0 * dir, dir, turn)
        })
        .collect();
    (parsed(&text), rays)
}

#[test]
fn boxes_turned_by_30_degrees_are_one_span_with_the_suggested_weld() {
    let (mut dice, mut parted) = (Dice::new(1), 0);
    let turn = DAffine3::from_quat(DQuat::from_rotation_z(30.0_f64.to_radians()));
    let turn = DAffine3::from_translation(dvec3(12.3457, 1.0, 0.0)) * turn;
    for _ in 0..20 {
        let (solid, rays) = abutting(&turn, &mut dice);
        let weld = suggested(&solid).expect("they nearly coincide");
        assert!(weld > 1e-7 && weld < 1e-3, "{weld}");
        let (plain, welded) = (scene(&solid), welded(&solid, weld));
        parted += u32::from(rays.iter().any(|ray| counted(&plain, ray) == 2));
        assert!(rays.iter().all(|ray| counted(&welded, ray) == 1));
        let facing = |weld: &&Weld| weld.faces == [1, 0] || weld.faces == [0, 1];
        assert_eq!(welded.welds().iter().filter(facing).count(), 1);
        assert!(welded.welds().iter().all(|w| w.distance <= weld && w.distance > 0.0));
    }
    assert!(parted > 5, "only {parted}");
}

/// A third of them overlap by a little and are one span already.
#[test]
fn boxes_turned_at_random_are_one_span_with_the_suggested_weld() {
    let (mut dice, mut parted) = (Dice::new(2), 0);
    for i in 0..1000 {
        let turn = DAffine3::from_translation(dice.point(100.0))
            * DAffine3::from_mat3(dice.rotation());
        let (solid, rays) = abutting(&turn, &mut dice);
        let plain = scene(&solid);
        parted += u32::from(rays.iter().any(|ray| counted(&plain, ray) == 2));
        let Some(weld) = suggested(&solid) else {
            panic!("{i}: no suggestion");
        };
        let welded = welded(&solid, weld);
        assert!(rays.iter().all(|ray| counted(&welded, ray) == 1), "{i}: {weld}");
        assert!(weld < 2e-3, "{i}: {weld}");
        // Nothing is left to suggest.
        let left = Scene::near_misses(&solid, &welding(weld)).expect("it is fine");
        assert_eq!(left.pairs, [], "{i}");
    }
    assert!(parted > 300, "only {parted}");
}

/// A cylinder from one end, and again from the other.
#[test]
fn copies_of_curved_solids_leave_nothing_with_the_suggested_weld() {
    let mut dice = Dice::new(3);
    let shapes = [
        "sphere($fn = 0, $fa = 12, $fs = 2, r = 6.54321);",
        "cylinder($fn = 0, $fa = 12, $fs = 2, h = 10, r1 = 3.21, r2 = 3.21, center = true);",
        "cylinder($fn = 0, $fa = 12, $fs = 2, h = 10, r1 = 4, r2 = 2, center = true);",
    ];
    let (mut films, mut count) = (0, 0);
    for i in 0..300 {
        let place = DAffine3::from_translation(dice.point(100.0))
            * DAffine3::from_mat3(dice.rotation());
        // The same again, by two maps that are printed.
        let half = DAffine3::from_mat3(dice.rotation());
        let rest = place * half.inverse();
        let shape = shapes[i % shapes.len()];
        let once = multmatrix(&place, shape);
        let twice = multmatrix(&rest, &multmatrix(&half, shape));
        let solid = parsed(&format!("difference() {{ {once} {twice} }}"));
        let weld = suggested(&solid).unwrap_or_else(|| panic!("{i}: no suggestion"));
        let (plain, welded) = (scene(&solid), welded(&solid, weld));
        for _ in 0..20 {
            let ray = mapped(4.0 * dice.direction(), dice.direction(), &place);
            films += counted(&plain, &ray);
            assert_eq!(counted(&welded, &ray), 0, "{i}: {weld}");
            count += 1;
        }
    }
    assert!(films > count / 2, "{films} films of {count}");
}

#[test]
fn a_flush_cut_leaves_a_film_only_without_a_weld() {
    let mut dice = Dice::new(4);
    let mut films = 0;
    for i in 0..200 {
        let turn = DAffine3::from_translation(dice.point(50.0))
            * DAffine3::from_mat3(dice.rotation());
        // A plate, and what cuts off all of it from a height of 7 on: flush with its top.
        let cut = turn * DAffine3::from_translation(dvec3(-1.0, -1.0, 7.0));
        let plate = multmatrix(&turn, &cube(dvec3(20.0, 20.0, 10.0)));
        let cutter = multmatrix(&cut, &cube(dvec3(22.0, 22.0, 3.0)));
        let solid = parsed(&format!("difference() {{ {plate} {cutter} }}"));
        let weld = suggested(&solid).unwrap_or_else(|| panic!("{i}: no suggestion"));
        let (plain, welded) = (scene(&solid), welded(&solid, weld));
        for _ in 0..8 {
            let through = dvec3(dice.within(1.0, 19.0), dice.within(1.0, 19.0), 10.0);
            let dir = DVec3::Z + 0.1 * dice.direction();
            let ray = mapped(through - 30.0 * dir, dir, &turn);
            films += counted(&plain, &ray) - 1;
            assert_eq!(counted(&welded, &ray), 1, "{i}: {weld}");
        }
    }
    assert!(films > 400, "only {films}");
}

/// Boxes from these x on, of these widths, one unit high and deep.
fn row(from: &[f64], wide: &[f64]) -> Vec<Solid> {
    let place = |(&x, &w): (&f64, &f64)| {
        Solid::cuboid_between(dvec3(x, 0.0, 0.0), dvec3(x + w, 1.0, 1.0))
    };
    from.iter().zip(wide).map(place).collect()
}

fn union(solids: impl IntoIterator<Item = Solid>) -> Solid {
    Solid::boolean(solidray::Op::Union, solids)
}

#[test]
fn a_weld_joins_gaps_and_overlaps_up_to_its_length() {
    let x = Ray::new(dvec3(-1.0, 0.5, 0.5), DVec3::X);
    for gap in [1e-3, -1e-3] {
        let pair = union(row(&[0.0, 2.0 + gap], &[2.0, 1.0]));
        let list = ends_in(&welded(&pair, 1.01e-3), &x);
        assert!(list.len() == 1 && (list[0][1] - 4.0 - gap).abs() < 1e-12, "{list:?}");
        let not_enough = welded(&pair, 0.99e-3);
        assert_eq!(not_enough.welds(), []);
        assert_eq!(counted(&not_enough, &x), if gap > 0.0 { 2 } else { 1 });
        // The common part is a film with an overlap and nothing with a weld.
        let [a, b] = [0, 1].map(|i| row(&[0.0, 2.0 + gap], &[2.0, 1.0])[i].clone());
        assert_eq!(counted(&welded(&(a & b), 1.01e-3), &x), 0);
    }
}

/// The bounds are those of the leaves after they have been welded, to the bit.
#[test]
fn bounds_are_those_of_the_welded_leaves() {
    let top = Solid::cuboid_between(dvec3(0.0, 0.0, 1.0), dvec3(1.0, 1.0, 2.0));
    let bottom = Solid::cuboid_between(DVec3::ZERO, dvec3(3.0, 1.001, 1.0));
    let scene = welded(&(top.clone() + bottom.clone()), 2e-3);
    assert_eq!(scene.bounds().max, dvec3(3.0, 1.001, 2.0));
    let only_top = welded(&(top & (bottom.translated(dvec3(0.0, 0.0, 0.5)))), 2e-3);
    assert_eq!(only_top.bounds().max, dvec3(1.0, 1.001, 1.5));
}

#[test]
fn distance_is_measured_square_to_the_surface() {
    // Two planes a thousandth apart are far apart along a line that all but lies in them.
    let slab =
        |z: f64| Solid::cuboid_between(dvec3(-5.0, -5.0, z), dvec3(5.0, 5.0, z + 1.0));
    let cut = slab(0.0) - slab(1e-3);
    let grazing = Ray::new(dvec3(-50.0, 0.0, 0.0), dvec3(1.0, 0.0, 1e-5));
    assert_eq!(counted(&scene(&cut), &grazing), 1);
    assert_eq!(counted(&welded(&cut, 1.1e-3), &grazing), 0);
}

/// What is far away cannot be parted by a gap, however alike it lies.
#[test]
fn only_leaves_that_touch_are_welded() {
    let apart = union(
        row(&[0.0, 10.0], &[1.0, 1.0])
            .into_iter()
            .enumerate()
            .map(|(i, solid)| solid.translated(dvec3(0.0, 0.0, 1e-3 * i as f64))),
    );
    assert_eq!(welded(&apart, 1e-2).welds(), []);
}

/// What lies alike is not joined by a weld that does not reach from leaf to leaf.
#[test]
fn a_suggested_weld_reaches_from_leaf_to_leaf() {
    let text = "union() {
multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 12.3456], [0, 0, 0, 1]])
cube(size = [7.77777, 1, 1], center = false);
multmatrix([[1, 0, 0, 7.7778], [0, 1, 0, 0], [0, 0, 1, 12.3457], [0, 0, 0, 1]])
cube(size = [1.23456, 1, 1], center = false);
}
";
    let solid = parsed(text);
    let weld = suggested(&solid).expect("they nearly coincide");
    let left = Scene::near_misses(&solid, &welding(weld)).expect("it is fine");
    assert_eq!(left.pairs, []);
    assert_eq!(welded(&solid, weld).welds().len(), 3);
}

#[test]
fn a_chain_is_refused_with_its_leaves_and_a_weld_that_would_do() {
    let text = "union() {
\tcube(size = [5, 1, 1], center = false);
\tmultmatrix([[1, 0, 0, 5.008], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
\t\tcube(size = [4, 1, 1], center = false);
\tmultmatrix([[1, 0, 0, 5.013], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
\t\tcube(size = [3, 1, 1], center = false);
}
";
    let solid = parsed(text);
    let message = refused(&solid, 0.01).to_string();
    assert_eq!(
        message,
        "2:2: leaf 0 (cuboid), 4:3: leaf 1 (cuboid) and 6:3: leaf 2 (cuboid) have surfaces \
         that nearly coincide in turn, but the first and the last are 1.30e-2 apart, farther \
         than the weld of 0.01; a weld of 0.00799 would do"
    );
    assert_eq!(welded(&solid, 0.00799).welds().len(), 1);
    assert_eq!(welded(&solid, 0.0131).welds().len(), 2);
    // In turn, each farther from the first than the one before.
    let stairs = |n: u32| {
        let from: Vec<f64> = (0..n).map(|i| 0.001 * f64::from(i)).collect();
        let wide: Vec<f64> = (0..n).map(|i| 5.0 + f64::from(i)).collect();
        union(row(&from, &wide))
    };
    let CompileError::ChainOfWelds { fine, apart, weld, .. } =
        refused(&stairs(40), 0.0015)
    else {
        panic!("a chain")
    };
    assert_eq!((fine, weld), (0.0, 0.0015));
    assert!(apart > 0.0015 && apart < 0.04, "{apart}");
    assert_eq!(welded(&stairs(40), 0.0401).welds().len(), 39);
}

#[test]
fn a_leaf_keeps_its_thickness() {
    let x = Ray::new(dvec3(-1.0, 0.5, 0.5), DVec3::X);
    // Alone it may be as thin as it likes.
    let leaf = row(&[1.0], &[1e-3]).remove(0);
    let found = ends_in(&welded(&leaf, 1.0), &x);
    assert_eq!(found, [[2.0, 2.001]]);
    // A neighbour on one side, farther from the other side than the weld.
    let beside = union(row(&[1.0, 1.0015], &[1e-3, 5.0]));
    let found = ends_in(&welded(&beside, 0.9e-3), &x);
    assert_eq!(found, [[2.0, 7.0015]]);
    // A neighbour that both faces are near.
    let error = refused(&beside, 0.01);
    let CompileError::WeldOfThinLeaf { leaves, apart, weld, fine } = &error else {
        panic!("{error}")
    };
    assert_eq!((leaves[0].number, leaves[1].number, *weld), (0, 1, 0.01));
    assert!((apart - 1e-3).abs() < 1e-12 && *fine >= 0.5e-3 && *fine < 1.5e-3);
    assert!(Scene::compile_with(&beside, &welding(*fine)).is_ok());
    let message = error.to_string();
    let expected = "a weld of 0.01 joins two faces of leaf 0 (cuboid), which are 1.00e-3 apart, by way \
         of leaf 1 (cuboid); a weld of ";
    assert!(message.starts_with(expected), "{message}");
    // So it is at rounding, where nobody has asked for a weld.
    let film = row(&[1.0], &[4e-16]).remove(0);
    let there = union([film.clone(), row(&[1.0], &[5.0]).remove(0)]);
    assert_eq!(ends_in(&scene(&there), &x), [[2.0, 7.0]]);
}

/// A large face keeps its place when something small and askew is welded to it.
#[test]
fn the_largest_leads() {
    let plate =
        Solid::cuboid_between(dvec3(-500.0, -500.0, -1.0), dvec3(500.0, 500.0, 0.0));
    let pin = Solid::cuboid_between(dvec3(-0.01, -0.01, 0.0), dvec3(0.01, 0.01, 5.0));
    let askew = Solid::cuboid_between(dvec3(-0.01, -0.01, 0.0), dvec3(0.01, 0.01, 0.02))
        .rotated(DVec3::X, 1e-3)
        .translated(dvec3(100.0, 0.0, 0.0));
    let [one, other] = [plate.clone() + askew.clone() + pin.clone(), pin + askew + plate];
    for solid in [one, other] {
        let scene = welded(&solid, 1e-4);
        assert_eq!(scene.welds().len(), 1);
        let ray = Ray::new(dvec3(0.5, -499.0, 10.0), -DVec3::Z);
        assert_eq!(ends_in(&scene, &ray), [[10.0, 11.0]]);
    }
}

#[test]
fn a_weld_that_is_no_length_is_refused() {
    for weld in [-1.0, f64::NAN, f64::INFINITY] {
        let message = refused(&Solid::ball(1.0), weld).to_string();
        let expected =
            format!("the weld is {weld}, which is not a finite length of at least zero");
        assert_eq!(message, expected);
    }
}

/// A heap of boxes, cylinders and balls whose surfaces are off by a little.
fn heap(dice: &mut Dice, exact: bool) -> Vec<Solid> {
    let turn = dice.rotation();
    (0..12)
        .map(|_| {
            let mut off = |x: f64| if exact { x } else { x + dice.within(-1e-6, 1e-6) };
            let size = dvec3(off(2.0), off(2.0), off(2.0));
            let cell = [off(0.0), off(0.0), off(0.0)];
            let cell = DVec3::from_array(cell.map(|x| x + 2.0 * dice.below(3) as f64));
            let leaf = match dice.below(3) {
                0 => Solid::cuboid_between(DVec3::ZERO, size),
                1 => Solid::cylinder(1.0, 2.0),
                _ => Solid::ball(2.0),
            };
            let slant = if exact { 0.0 } else { dice.within(-1e-6, 1e-6) };
            leaf.rotated(DVec3::Y, slant)
                .translated(cell)
                .mapped(DAffine3::from_mat3(turn))
        })
        .collect()
}

fn shuffled(mut solids: Vec<Solid>, dice: &mut Dice) -> Vec<Solid> {
    for i in (1..solids.len()).rev() {
        solids.swap(i, dice.below(i + 1));
    }
    solids
}

#[test]
fn the_order_of_operands_changes_no_bit() {
    let (mut dice, mut joined) = (Dice::new(5), 0);
    for i in 0..200 {
        let solids = heap(&mut dice, i % 2 == 0);
        let others = shuffled(solids.clone(), &mut dice);
        for weld in [0.0, 2e-5] {
            let [a, b] = [&solids, &others].map(|s| welded(&union(s.clone()), weld));
            assert_eq!(a.bounds(), b.bounds());
            assert_eq!(a.welds().len(), b.welds().len());
            joined += a.welds().len();
            for _ in 0..20 {
                let ray = Ray::new(10.0 * dice.direction(), dice.direction());
                let ray = Ray { dir: dice.point(5.0) - ray.origin, ..ray };
                assert_eq!(ends_in(&a, &ray), ends_in(&b, &ray), "{i}, {weld}");
            }
        }
    }
    assert!(joined > 200, "only {joined}");
}

/// A weld of zero is none, and one that finds nothing to join changes nothing.
#[test]
fn no_weld_changes_no_bit() {
    let mut dice = Dice::new(6);
    for _ in 0..100 {
        let solid = union(heap(&mut dice, true));
        let plain = scene(&solid);
        for weld in [0.0, 1e-6] {
            let same = welded(&solid, weld);
            assert_eq!((same.welds(), same.bounds()), (&[][..], plain.bounds()));
            for _ in 0..20 {
                let origin = 10.0 * dice.direction();
                let ray = Ray::new(origin, dice.point(5.0) - origin);
                assert_eq!(ends_in(&same, &ray), ends_in(&plain, &ray));
            }
        }
    }
}

/// People part surfaces by a hundredth to make cuts go through; six digits can tell that.
#[test]
fn what_was_meant_to_be_apart_is_no_near_miss() {
    for (height, extra) in [(10.0, 0.01), (200.0, 0.001), (33.3333, 0.001), (10.0, 0.0)] {
        let top = printed(height + extra);
        let text = format!(
            "difference() {{ cube(size = [9, 9, {height}], center = false);
            multmatrix([[1, 0, 0, 2], [0, 1, 0, 2], [0, 0, 1, {extra}], [0, 0, 0, 1]]) {{
            cube(size = [3, 3, {top}], center = false); }} }}"
        );
        assert_eq!(suggested(&parsed(&text)), None, "{height} + {extra}");
    }
}

/// Sheared and mirrored maps, where a distance is not the same in every direction.
#[test]
fn nothing_moves_farther_than_the_weld() {
    let mut dice = Dice::new(7);
    let mut joined = 0;
    for i in 0..300 {
        let shear = DMat3::from_cols(
            dvec3(1.0, dice.within(-0.5, 0.5), 0.0),
            dvec3(0.0, dice.within(0.2, 2.0), dice.within(-0.5, 0.5)),
            dvec3(dice.within(-0.5, 0.5), 0.0, -1.0),
        );
        let map = DAffine3::from_mat3(dice.rotation() * shear);
        let leaf = match i % 3 {
            0 => Solid::cuboid(DVec3::splat(2.0)),
            1 => Solid::ball(1.0),
            _ => Solid::cylinder(1.0, 2.0).translated(dvec3(0.0, 0.0, -1.0)),
        };
        let off = DAffine3::from_translation(dice.point(1e-4))
            * DAffine3::from_axis_angle(dice.direction(), dice.within(0.0, 1e-4));
        let weld = 10.0_f64.powf(dice.within(-5.0, -2.0));
        let pair = leaf.clone().mapped(map) + leaf.clone().mapped(map * off);
        let welded = welded(&pair, weld);
        joined += welded.welds().len();
        let plain = scene(&pair);
        for _ in 0..10 {
            let ray = mapped(dice.point(0.3), dice.direction(), &map);
            let [a, b] = [&plain, &welded].map(|scene| ends_in(scene, &ray));
            assert_eq!((a.len(), b.len()), (1, 1), "{i}");
            // Both pass the surface at no more than a right angle less what the shear does.
            let moved = (a[0][1] - b[0][1]).abs() * ray.dir.length();
            assert!(moved <= 20.0 * weld + 1e-12, "{i}: {moved} of {weld}");
        }
    }
    assert!(joined > 100, "only {joined}");
}
