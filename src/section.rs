//! Solids cut open.

use glam::DVec3;

use crate::op::Op;
use crate::solid::Solid;

impl Solid {
    /// What is left of a solid where `normal · p ≤ offset`. The face of the cut has the names and
    /// colours of the parts that it cuts through, and is a face of half-spaces.
    #[must_use]
    pub fn section(&self, normal: DVec3, offset: f64) -> Self {
        let pieces = self.parts().into_iter().map(|(part, solid)| {
            let mut half = Self::half_space(normal, offset);
            if let Some(name) = part.name {
                half = half.named(&*name);
            }
            if let Some(color) = part.color {
                half = half.colored(color);
            }
            solid & half
        });
        Self::boolean(Op::Union, pieces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Color, Ray, Scene};

    #[test]
    fn cut_faces_are_of_the_parts_that_are_cut() {
        let red = Color::rgb(1.0, 0.0, 0.0);
        let ball = Solid::ball(2.0).translated(DVec3::new(-3.0, 0.0, 0.0)).colored(red);
        let cube = Solid::cuboid(DVec3::splat(2.0)).translated(DVec3::new(3.0, 0.0, 0.0));
        let half = (ball + cube).section(DVec3::Z, 0.25);
        let scene = Scene::compile(&half).expect("two halves");
        let mut tracer = scene.tracer();
        let mut seen = |x: f64| {
            let ray = Ray::new(DVec3::new(x, 0.1, 9.0), DVec3::NEG_Z);
            let hit = tracer.first_hit(&ray).expect("the cut");
            assert!((ray.at(hit.t).z - 0.25).abs() < 1e-15);
            (scene.leaf(hit.leaf).kind, scene.leaf(hit.leaf).part.color)
        };
        assert_eq!(seen(-3.0), ("half-space", Some(red)));
        assert_eq!(seen(3.0), ("half-space", None));
        assert!(Scene::compile(&Solid::empty().section(DVec3::Z, 0.0)).is_ok());
    }
}
