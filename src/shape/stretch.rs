//! Where lines are inside a leaf.

use crate::lanes::Lanes;

/// A stretch of each line and the numbers of the faces that begin and end it; empty where
/// `enter < exit` does not hold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretch<L> {
    pub(crate) enter: L,
    pub(crate) exit: L,
    pub(crate) enter_face: L,
    pub(crate) exit_face: L,
}

impl<L: Lanes> Stretch<L> {
    /// The whole of the lines.
    #[inline(always)]
    pub(super) fn all(like: L) -> Self {
        let zero = like.same(0.0);
        Self {
            enter: like.same(f64::NEG_INFINITY),
            exit: like.same(f64::INFINITY),
            enter_face: zero,
            exit_face: zero,
        }
    }

    /// What of it is between two places on a face. Where the face ends the line at the same place
    /// as another one, that one has been there first.
    #[inline(always)]
    pub(super) fn cut(self, from: L, to: L, face: u32) -> Self {
        let face = from.same(f64::from(face));
        let (later, earlier) = (self.enter.less(from), to.less(self.exit));
        Self {
            enter: L::select(later, from, self.enter),
            exit: L::select(earlier, to, self.exit),
            enter_face: L::select(later, face, self.enter_face),
            exit_face: L::select(earlier, face, self.exit_face),
        }
    }
}
