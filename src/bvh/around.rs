//! Boxes in the units of a tree, while it is built.

/// An item and its box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boxed {
    pub(super) around: Around,
    pub(super) item: u32,
}

/// A box in the units of a tree. A corner has a fourth number, which means nothing: four of
/// them fill a vector.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    pub(super) low: [f32; 4],
    pub(super) high: [f32; 4],
}

impl Around {
    pub(super) const EMPTY: Self =
        Self { low: [f32::INFINITY; 4], high: [f32::NEG_INFINITY; 4] };

    pub(super) fn of(items: &[Boxed]) -> Self {
        let mut around = Self::EMPTY;
        for item in items {
            around.add(&item.around);
        }
        around
    }

    /// Compares numbers as one instruction does for four: `f32::min` looks for what is no
    /// number as well.
    #[inline(always)]
    pub(super) fn add(&mut self, other: &Self) {
        for (low, &x) in self.low.iter_mut().zip(&other.low) {
            *low = if x < *low { x } else { *low };
        }
        for (high, &x) in self.high.iter_mut().zip(&other.high) {
            *high = if x > *high { x } else { *high };
        }
    }

    #[inline(always)]
    pub(super) fn add_point(&mut self, point: [f32; 4]) {
        self.add(&Self { low: point, high: point });
    }

    /// Twice the middle.
    #[inline(always)]
    pub(super) fn middle(&self) -> [f32; 4] {
        std::array::from_fn(|k| self.low[k] + self.high[k])
    }

    /// How large it is on an axis.
    #[inline(always)]
    pub(super) fn size(&self, axis: usize) -> f32 {
        self.high[axis] - self.low[axis]
    }

    /// Half the surface; zero of none.
    #[inline(always)]
    pub(super) fn area(&self) -> f32 {
        let [x, y, z] = std::array::from_fn(|k| self.size(k).max(0.0));
        x * y + y * z + z * x
    }
}
