//! How much work rays take, counted, so that what culls can be tested without a clock.

#[cfg(test)]
use std::ops::AddAssign;

/// What has been done for some rays. Counting costs an addition or two for each region and each
/// block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Work {
    /// Regions that were looked at.
    pub(crate) regions: u64,
    /// Leaves of which it was asked what they are to a region.
    pub(crate) sides: u64,
    /// Leaves that single rays met.
    pub(crate) meetings: u64,
    /// Rays that were walked along one by one.
    pub(crate) walks: u64,
    /// Rays for which the whole scene was searched.
    pub(crate) searches: u64,
}

#[cfg(test)]
impl AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.regions += other.regions;
        self.sides += other.sides;
        self.meetings += other.meetings;
        self.walks += other.walks;
        self.searches += other.searches;
    }
}
