//! What a picture is of.

use crate::aabb::Aabb;
use crate::color::Color;
use crate::scene::Scene;

/// What a picture is of: a solid, and what can be seen through before it.
///
/// A scene alone is shown by itself: `picture(&scene, …)`.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// What hides what is behind it, whatever the opacity of its colours.
    pub solid: &'a Scene,
    /// What is seen through, in any order, in looks that have light.
    pub translucent: &'a [Translucent<'a>],
}

/// A solid that is seen through: its nearest surface covers what is behind it in part. It throws no
/// shadow, and [soft light](super::Light::Soft) falls on it as plain light does.
#[derive(Clone, Copy, Debug)]
pub struct Translucent<'a> {
    /// The solid.
    pub scene: &'a Scene,
    /// Its colour; where its opacity is 0 nothing is seen of it, where it is 1 nothing through it.
    pub color: Color,
}

impl Shown<'_> {
    /// The bounds of all that is shown.
    pub fn bounds(&self) -> Aabb {
        let translucent = self.translucent.iter().map(|layer| layer.scene.bounds());
        translucent.fold(self.solid.bounds(), Aabb::hull)
    }
}

impl<'a> From<&'a Scene> for Shown<'a> {
    fn from(solid: &'a Scene) -> Self {
        Self { solid, translucent: &[] }
    }
}
