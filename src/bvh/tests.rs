use glam::dvec3;
use proptest::prelude::*;

use super::*;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1.0..1.0,
        Just(0.0),
        (-4..=4_i32).prop_map(|i| 0.25 * f64::from(i)),
        (-1.0..1.0).prop_map(|x| 1e-7 * x),
    ]
}

fn vector() -> impl Strategy<Value = DVec3> {
    [number(), number(), number()].prop_map(DVec3::from_array)
}

fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
    let one = (vector(), vector(), prop_oneof![Just(0.0), Just(1e-9), 0.0..0.3]);
    let one = one.prop_map(|(at, size, part)| Aabb::around([at, at + part * size]));
    // Many boxes in one place cannot be told apart.
    (proptest::collection::vec(one, 0..200), 1..4_usize)
        .prop_map(|(boxes, times)| boxes.repeat(times))
}

/// Where in space, and how large, and how far away the line's origin is.
fn frames() -> impl Strategy<Value = (f64, DVec3, f64)> {
    let scale = prop_oneof![Just(1.0), Just(1e-200), Just(1e150), Just(3e-5)];
    let away = prop_oneof![Just(0.0), Just(5.0), Just(-1e8)];
    (scale, prop_oneof![Just(DVec3::ZERO), Just(dvec3(148_376.0, 1.0, -2e5))], away)
}

proptest! {
    /// What the line crosses by numbers of double precision is visited, once.
    #[test]
    fn lines_visit_every_item_whose_box_they_cross(
        boxes in boxes(),
        from in vector(),
        dir in vector(),
        (scale, offset, away) in frames(),
        most in 1..=EIGHT,
    ) {
        prop_assume!(dir != DVec3::ZERO);
        let boxes: Vec<Aabb> = boxes
            .iter()
            .map(|b| Aabb::new(scale * (b.min + offset), scale * (b.max + offset)))
            .collect();
        let items = (0..).zip(boxes.iter().copied());
        let mut ends: Vec<Vec<u32>> = Vec::new();
        let tree = Bvh::grouped(items, most, |items| {
            ends.push(items.to_vec());
            count(ends.len() - 1)
        });
        let slabs = tree.slabs(scale * (from + offset + away * dir), dir);
        let mut visited = vec![0; boxes.len()];
        tree.crossed(&slabs, |end| {
            ends[end as usize].iter().for_each(|&i| visited[i as usize] += 1);
        });
        for (i, (b, times)) in boxes.iter().zip(visited).enumerate() {
            prop_assert!(times <= 1);
            prop_assert!(times == 1 || !slabs.cross(b), "{i}: {b:?}");
        }
        prop_assert!(ends.iter().all(|end| (1..=most).contains(&end.len())));
        let mut all = ends.concat();
        all.sort_unstable();
        prop_assert!(all.into_iter().eq(0..count(boxes.len())));
    }

    /// The same for regions of any kind.
    #[test]
    fn what_meets_a_box_is_visited(
        boxes in boxes(),
        at in vector(),
        (scale, offset, _) in frames(),
    ) {
        let boxes: Vec<Aabb> = boxes
            .iter()
            .map(|b| Aabb::new(scale * (b.min + offset), scale * (b.max + offset)))
            .collect();
        let tree = Bvh::over((0..count(boxes.len())).collect(), &boxes);
        let place = Aabb::new(scale * (at + offset), scale * (at + offset + 0.1));
        let mut visited = vec![false; boxes.len()];
        tree.around(&place, |i| visited[i as usize] = true);
        for (b, visited) in boxes.iter().zip(visited) {
            prop_assert!(visited || b.intersection(place).is_empty(), "{b:?}");
        }
    }
}
