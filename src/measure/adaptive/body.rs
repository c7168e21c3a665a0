//! The solid as equations, and which of its surfaces matter where.

use glam::DVec3;

use super::form::Form;
use crate::scene::Equations;

/// The solid in coordinates u, v and w.
#[derive(Debug)]
pub(super) struct Body<'a> {
    equations: Equations<'a>,
    /// The surfaces, each with coefficients of length 1.
    pub(super) forms: Vec<Form>,
}

/// Bits of surfaces.
pub(super) type Set = u64;

/// The numbers of the surfaces in a set.
pub(super) fn numbers(set: Set) -> impl Iterator<Item = usize> {
    (0_usize..64).filter(move |i| set >> i & 1 == 1)
}

/// Where more surfaces meet than this it is not worth while to ask which of them matter.
const MANY: usize = 6;

impl<'a> Body<'a> {
    pub(super) fn new(equations: Equations<'a>) -> Self {
        let forms = equations.surfaces.iter().map(Form::new);
        let forms = forms.map(|form| form.normalized().unwrap_or(form)).collect();
        Self { equations, forms }
    }

    /// Those of some surfaces that matter at a point on all of them: the solid there is
    /// another on the other side of that surface, for some choice of sides of the surfaces on
    /// which the point lies too, as those do whose forms are not larger than `near`.
    pub(super) fn matter(
        &self,
        point: DVec3,
        on: Set,
        near: f64,
        counts: &mut Vec<u32>,
    ) -> Set {
        let (mut positive, mut undecided) = (0, on);
        for (i, form) in self.forms.iter().enumerate() {
            let value = form.value(point);
            positive |= Set::from(value > 0.0) << i;
            undecided |= Set::from(value.abs() <= near) << i;
        }
        let mut bits: [Set; MANY] = [0; MANY];
        let count = undecided.count_ones() as usize;
        if count > MANY {
            return undecided;
        }
        bits.iter_mut().zip(numbers(undecided)).for_each(|(bit, i)| *bit = 1 << i);
        // Bit c says whether the solid is there for choice c of sides.
        let mut inside = 0_u64;
        for choice in 0..1_u64 << count {
            let sides = (0..count)
                .filter(|k| choice >> k & 1 == 1)
                .fold(positive & !undecided, |sides, k| sides | bits[k]);
            inside |= u64::from(self.equations.is_inside(sides, counts)) << choice;
        }
        let differ = |choice: u64, k: usize| {
            (inside >> choice ^ inside >> (choice ^ 1 << k)) & 1 == 1
        };
        let matters = |k: &usize| (0..1_u64 << count).any(|choice| differ(choice, *k));
        (0..count).filter(matters).fold(0, |set, k| set | bits[k])
    }
}
