//! Numbers: volume, surface, centroid and inertia, what solids share and how much they differ,
//! each with an interval that is true.

mod adaptive;
mod apart;
mod beam;
mod binomial;
mod bracket;
mod column;
mod compare;
mod estimate;
mod exact;
mod lattice;
mod overlap;
mod points;
mod properties;
mod several;
mod shares;
mod spread;
mod strata;
mod volume;

pub use adaptive::{Unsuited, adaptive, adaptive_with};
pub use apart::{Apart, Search, apart};
pub use bracket::bracket;
pub use compare::{Comparison, Verdict, Worst, compare, compare_with};
pub use estimate::{Estimate, Method};
pub use exact::exact;
pub use lattice::Sampling;
pub use overlap::{Deepest, Overlap, overlaps};
pub use points::points;
pub use properties::{
    Body, Mass, MergeError, Missed, Principal, Properties, Quantity, Replicate, Run,
    mass, merge, properties, run,
};
pub use volume::{volume, volume_with};
