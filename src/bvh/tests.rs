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

/// Boxes of which each split parts few from many: each is half as far away as the one before.
fn boxes_in_a_row() -> impl Strategy<Value = Vec<Aabb>> {
    let direction = prop_oneof![Just(DVec3::X), Just(DVec3::ONE), vector()];
    (direction, prop_oneof![Just(0.0), 0.0..2.0], 1..300).prop_map(|(dir, size, n)| {
        let place = |i: i32| 0.5_f64.powi(i) * dir;
        (0..n).map(|i| Aabb::around([place(i), (1.0 + size) * place(i)])).collect()
    })
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

    /// Boxes hold what is below them, each item is at one end, and neither the way down nor
    /// what is waiting is longer than it should be.
    #[test]
    fn boxes_hold_what_is_below_them(
        boxes in prop_oneof![boxes(), boxes_in_a_row()],
        (scale, offset, _) in frames(),
        most in 1..=EIGHT,
    ) {
        let boxes: Vec<Aabb> = boxes
            .iter()
            .map(|b| Aabb::new(scale * (b.min + offset), scale * (b.max + offset)))
            .collect();
        let mut ends: Vec<Vec<u32>> = Vec::new();
        let tree = Bvh::grouped((0..).zip(boxes.iter().copied()), most, |items| {
            ends.push(items.to_vec());
            count(ends.len() - 1)
        });
        let holds = |outer: &Around, inner: &Around| {
            (0..3).all(|k| outer.low[k] <= inner.low[k] && outer.high[k] >= inner.high[k])
        };
        let everything = Around { low: [-2.0; 4], high: [2.0; 4] };
        let mut open = vec![(0, everything, 1, 0)];
        let mut all = Vec::new();
        while let Some((node, outer, depth, waiting)) = open.pop() {
            let node = &tree.nodes[node as usize];
            let used = node.children.iter().filter(|&&child| child != NONE).count();
            prop_assert!(depth <= 32 + boxes.len().max(1).ilog2() as usize + 1);
            prop_assert!(waiting <= tree.waiting);
            prop_assert!(used > 1 || boxes.len() <= most);
            for (slot, &child) in node.children.iter().enumerate().take(used) {
                let around = node.child(slot);
                prop_assert!(holds(&outer, &around));
                if child & END == 0 {
                    open.push((child, around, depth + 1, waiting + used - 1));
                    continue;
                }
                for &i in &ends[(child & !END) as usize] {
                    prop_assert!(holds(&around, &tree.unit.around(&boxes[i as usize])));
                    all.push(i);
                }
            }
        }
        all.sort_unstable();
        prop_assert!(all.into_iter().eq(0..count(boxes.len())));
    }
}
