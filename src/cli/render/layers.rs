//! What is seen through: colours that are not opaque, and what OpenSCAD's `%` and `#` mark.

use solidray::read::Marks;
use solidray::{Color, Op, Scene, Solid};

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
    /// How many colours are drawn as if they were opaque, because there are too many.
    pub(super) too_many: usize,
}

impl Layers {
    /// A solid with what is marked in its model, and its own colours taken apart if some of them are
    /// seen through. Parts of one colour are seen as one; what is without any opacity is not seen.
    pub(super) fn new(solid: Solid, has_glass: bool, marks: Marks) -> Self {
        let mut layers = Self { opaque: solid, translucent: Vec::new(), too_many: 0 };
        if has_glass {
            layers.separate();
        }
        for (solid, color) in
            [(marks.background, BACKGROUND), (marks.highlighted, HIGHLIGHTED)]
        {
            if !is_empty(&solid) {
                layers.translucent.push((solid, color));
            }
        }
        layers
    }

    /// Takes what is not opaque from what is.
    fn separate(&mut self) {
        let parts = self.opaque.parts();
        let mut opaque = Vec::new();
        let mut colors: Vec<(Color, Vec<Solid>)> = Vec::new();
        for (part, solid) in parts {
            match part.color {
                Some(color) if color.rgba[3] <= 0.0 => {}
                Some(color) if color.rgba[3] < 1.0 => {
                    match colors.iter_mut().find(|(known, _)| *known == color) {
                        Some((_, solids)) => solids.push(solid),
                        None => colors.push((color, vec![solid])),
                    }
                }
                _ => opaque.push(solid),
            }
        }
        let all = |solids| Solid::boolean(Op::Union, solids);
        let others = colors.split_off(colors.len().min(MOST));
        self.too_many = others.len();
        opaque.extend(others.into_iter().flat_map(|(_, solids)| solids));
        self.opaque = all(opaque);
        self.translucent =
            colors.into_iter().map(|(color, solids)| (all(solids), color)).collect();
    }

    /// What becomes of each solid.
    #[must_use]
    pub(super) fn changed(self, change: impl Fn(Solid) -> Solid) -> Self {
        let Self { opaque, translucent, too_many } = self;
        let translucent = translucent.into_iter().map(|(s, color)| (change(s), color));
        Self { opaque: change(opaque), translucent: translucent.collect(), too_many }
    }
}

/// Whether a leaf of a scene has a colour that is not opaque.
pub(super) fn has_glass(scene: &Scene) -> bool {
    let mut leaves = (0..).take(scene.leaf_count()).map(|leaf| scene.leaf(leaf));
    leaves.any(|leaf| leaf.part.color.is_some_and(|color| color.rgba[3] < 1.0))
}

fn is_empty(solid: &Solid) -> bool {
    matches!(solid.view(), solidray::View::Boolean(Op::Union, []))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_that_are_not_opaque_are_layers() {
        let glass = |r, alpha| Color { rgba: [r, 0.0, 0.0, alpha] };
        let ball = |color| Solid::ball(1.0).colored(color);
        let solid = ball(glass(1.0, 0.5))
            + ball(glass(0.5, 1.0))
            + ball(glass(1.0, 0.5))
            + ball(glass(0.0, 0.0))
            + Solid::ball(2.0);
        assert!(has_glass(&Scene::compile(&solid).expect("balls")));
        assert!(!has_glass(&Scene::compile(&Solid::ball(2.0)).expect("a ball")));
        let layers = Layers::new(solid, true, Marks::default());
        assert_eq!(layers.opaque.census().leaves, 2);
        let [(solid, color)] = &layers.translucent[..] else { panic!("one colour") };
        assert_eq!((solid.census().leaves, *color), (2, glass(1.0, 0.5)));

        #[expect(clippy::cast_precision_loss, reason = "small numbers")]
        let many = (0..MOST + 3).map(|i| ball(glass(i as f32 * 0.01, 0.5)));
        let layers = Layers::new(Solid::boolean(Op::Union, many), true, Marks::default());
        assert_eq!((layers.translucent.len(), layers.too_many), (MOST, 3));
        assert_eq!(layers.opaque.census().leaves, 3);
    }
}
