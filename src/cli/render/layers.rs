//! What is seen through: colours that are not opaque, and what OpenSCAD's `%` and `#` mark.

use std::collections::HashSet;

use solidray::read::Marks;
use solidray::{Color, Op, Part, Scene, Solid};

/// OpenSCAD's colour of what `#` marks.
const HIGHLIGHTED: Color =
    Color { rgba: [1.0, 81.0 / 255.0, 81.0 / 255.0, 128.0 / 255.0] };
/// OpenSCAD's colour of what `%` shows.
const BACKGROUND: Color =
    Color { rgba: [180.0 / 255.0, 180.0 / 255.0, 180.0 / 255.0, 128.0 / 255.0] };

/// The most colours that are seen through in a picture: each is traced by itself.
pub(super) const MOST: usize = 32;

/// A model as it is drawn.
pub(super) struct Layers {
    pub(super) opaque: Solid,
    pub(super) translucent: Vec<(Solid, Color)>,
    /// What is no part of the model.
    pub(super) marks: Vec<(Solid, Color)>,
    /// How many colours are drawn as if they were opaque, because there are too many.
    pub(super) too_many: usize,
}

impl Layers {
    /// A solid with what is marked in its model, and with its colours taken apart that are seen
    /// through. What has one colour is seen as one; what is without any opacity is not seen.
    pub(super) fn new(solid: Solid, glass: &[Color], marks: Marks) -> Self {
        let mut layers = Self {
            opaque: solid,
            translucent: Vec::new(),
            marks: Vec::new(),
            too_many: 0,
        };
        if !glass.is_empty() {
            layers.separate(glass);
        }
        for (solid, color) in
            [(marks.background, BACKGROUND), (marks.highlighted, HIGHLIGHTED)]
        {
            if !is_empty(&solid) {
                layers.marks.push((solid, color));
            }
        }
        layers
    }

    /// Takes what has these colours from what has others.
    fn separate(&mut self, glass: &[Color]) {
        let (shown, others) = glass.split_at(glass.len().min(MOST));
        self.too_many = others.len();
        let has = |colors: &[Color], part: &Part| {
            part.color.is_some_and(|color| colors.contains(&color))
        };
        let visible = shown.iter().filter(|color| color.rgba[3] > 0.0);
        let layer =
            |color: &Color| (self.opaque.of_parts(|part| has(&[*color], part)), *color);
        self.translucent =
            visible.map(layer).filter(|(solid, _)| !is_empty(solid)).collect();
        self.opaque = self.opaque.of_parts(|part| !has(shown, part));
    }

    /// What becomes of each solid.
    #[must_use]
    pub(super) fn changed(self, change: impl Fn(Solid) -> Solid) -> Self {
        let Self { opaque, translucent, marks, too_many } = self;
        let [translucent, marks] = [translucent, marks].map(|layers| {
            layers.into_iter().map(|(solid, color)| (change(solid), color)).collect()
        });
        Self { opaque: change(opaque), translucent, marks, too_many }
    }
}

/// The colours of a scene's leaves that are not opaque, in the order of the file.
pub(super) fn glass(scene: &Scene) -> Vec<Color> {
    let leaves = (0..).take(scene.leaf_count()).map(|leaf| scene.leaf(leaf));
    let mut known = HashSet::new();
    leaves
        .filter_map(|leaf| leaf.part.color)
        .filter(|color| color.rgba[3] < 1.0 && known.insert(color.rgba.map(f32::to_bits)))
        .collect()
}

fn is_empty(solid: &Solid) -> bool {
    matches!(solid.view(), solidray::View::Boolean(Op::Union, []))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn colors_that_are_not_opaque_are_layers() {
        let color = |r, alpha| Color { rgba: [r, 0.0, 0.0, alpha] };
        let ball = |color| Solid::ball(1.0).colored(color);
        let layers = |solid: Solid| {
            let scene = Scene::compile(&solid).expect("balls");
            Layers::new(solid, &glass(&scene), Marks::default())
        };
        let (glass, clear) = (color(1.0, 0.5), color(0.0, 0.0));
        let found = layers(
            ball(glass)
                + ball(color(0.5, 1.0))
                + ball(glass).translated(DVec3::X)
                + ball(clear)
                + Solid::ball(2.0),
        );
        assert_eq!(found.opaque.census().leaves, 2);
        let [(solid, found)] = &found.translucent[..] else { panic!("one colour") };
        assert_eq!((solid.census().leaves, *found), (2, glass));
        assert_eq!(layers(Solid::ball(2.0)).translucent.len(), 0);

        #[expect(clippy::cast_precision_loss, reason = "small numbers")]
        let many = (0..MOST + 3).map(|i| ball(color(i as f32 * 0.01, 0.5)));
        let apart =
            |(i, ball): (u32, Solid)| ball.translated(9.0 * f64::from(i) * DVec3::X);
        let found = layers(Solid::boolean(Op::Union, (0..).zip(many).map(apart)));
        assert_eq!((found.translucent.len(), found.too_many), (MOST, 3));
        assert_eq!(found.opaque.census().leaves, 3);
    }

    /// As many pieces as holes: each colour has all holes once, not each piece.
    #[test]
    fn what_is_subtracted_stays_one_list() {
        let at = |i: i32, y: f64| DVec3::new(f64::from(i), y, 0.0);
        let piece = |i: i32| {
            let alpha = if i == 0 { 1.0 } else { 0.5 };
            Solid::cuboid(DVec3::splat(0.5))
                .colored(Color { rgba: [0.0, 0.0, 1.0, alpha] })
                .translated(at(i, 0.0))
        };
        let hole = |i: i32| Solid::ball(0.1).translated(at(i, 0.25));
        let pieces = Solid::boolean(Op::Union, (0..1000).map(piece));
        let all = std::iter::once(pieces).chain((0..1000).map(hole));
        let solid = Solid::boolean(Op::Difference, all);
        let blue = Color { rgba: [0.0, 0.0, 1.0, 0.5] };
        let layers = Layers::new(solid, &[blue], Marks::default());
        assert_eq!(layers.opaque.census().leaves, 1001);
        assert_eq!(layers.translucent[0].0.census().leaves, 1999);
    }
}
