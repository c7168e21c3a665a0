//! The spans that the kernel finds against those of exact surfaces.

use solidray::{Ray, Scene, Sense};

use super::placed::{Meeting, Placed};
use super::sweep::holds;
use crate::support::model::Model;
use crate::support::spans;

/// A stretch of a line within which rounding decides: around one meeting with a surface, or
/// around several that are too close to be told apart.
#[derive(Debug)]
struct Cluster {
    from: f64,
    to: f64,
    /// Which surfaces are crossed, by leaf and number; twice where one is only touched.
    crossed: Vec<[usize; 2]>,
    /// The one crossing that it is around.
    only: Option<Meeting>,
    before: bool,
    after: bool,
    /// Whether there is at most one change, in whichever order the surfaces are crossed.
    is_clear: bool,
}

/// What came of a comparison.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Rays of which all spans could be told from each other.
    pub(crate) clear_rays: u32,
    pub(crate) rays: u32,
    /// Crossings compared one by one.
    pub(crate) crossings: u32,
    /// The largest error found, in units of what was allowed.
    pub(crate) worst: f64,
}

impl Tally {
    pub(crate) fn add(&mut self, other: Self) {
        self.clear_rays += other.clear_rays;
        self.rays += other.rays;
        self.crossings += other.crossings;
        self.worst = self.worst.max(other.worst);
    }
}

/// Between clusters the kernel finds nothing. In a clear one it finds one crossing, of the
/// right sense, if the solid changes there, and none if not; in another it may find a span
/// or a gap too many, but behind it is inside or outside as it should be.
pub(crate) fn compare(
    model: &Model,
    leaves: &[Placed],
    scene: &Scene,
    ray: &Ray,
) -> Tally {
    let bounds = scene.bounds();
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    let clusters = clusters(model, leaves, ray, largest);
    let found: Vec<_> =
        spans(scene, ray).iter().flat_map(|s| [s.enter, s.exit]).collect();
    let mut tally = Tally { rays: 1, ..Tally::default() };
    let mut rest = found.as_slice();
    let wrong =
        |what: &str| format!("{what}: {ray:?}: {found:?} instead of {clusters:?}");
    for cluster in &clusters {
        let here = rest.iter().take_while(|crossing| crossing.t <= cluster.to).count();
        let (in_cluster, behind) = rest.split_at(here);
        rest = behind;
        assert!(in_cluster.iter().all(|c| c.t >= cluster.from), "{}", wrong("stray"));
        let changes = cluster.before != cluster.after;
        let Some(only) = &cluster.only else {
            assert_eq!(here % 2 == 1, changes, "{}", wrong("parity"));
            continue;
        };
        assert_eq!(here, usize::from(changes), "{}", wrong("count"));
        for crossing in in_cluster {
            assert_eq!(
                crossing.sense == Sense::Enter,
                cluster.after,
                "{}",
                wrong("sense")
            );
            let error = (super::real::Real::exact(crossing.t) - &only.t).rounded().abs();
            tally.crossings += 1;
            tally.worst = tally.worst.max(error / only.error);
        }
    }
    assert!(rest.is_empty(), "{}", wrong("beyond"));
    tally.clear_rays = u32::from(clusters.iter().all(|cluster| cluster.is_clear));
    tally
}

fn clusters(model: &Model, leaves: &[Placed], ray: &Ray, largest: f64) -> Vec<Cluster> {
    let passes: Vec<_> = leaves.iter().map(|leaf| leaf.passes(ray, largest)).collect();
    let mut inside: Vec<Vec<bool>> = passes
        .iter()
        .map(|passes| passes.iter().map(|pass| pass.starts_inside).collect())
        .collect();
    let mut meetings: Vec<(f64, usize, usize, &Meeting)> = Vec::new();
    for (leaf, passes) in passes.iter().enumerate() {
        for (surface, pass) in passes.iter().enumerate() {
            let meet = |meeting| (Meeting::from(meeting), leaf, surface, meeting);
            meetings.extend(pass.meetings.iter().map(meet));
        }
    }
    meetings.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut clusters: Vec<Cluster> = Vec::new();
    for (from, leaf, surface, meeting) in meetings {
        let times = if meeting.crosses { 1 } else { 2 };
        let crossed = vec![[leaf, surface]; times];
        match clusters.last_mut() {
            Some(last) if last.to >= from => {
                (last.to, last.only) = (last.to.max(meeting.to()), None);
                last.crossed.extend(crossed);
            }
            _ => clusters.push(Cluster {
                from,
                to: meeting.to(),
                crossed,
                only: meeting.crosses.then(|| meeting.clone()),
                before: false,
                after: false,
                is_clear: false,
            }),
        }
    }
    for cluster in &mut clusters {
        cluster.judge(model, &mut inside);
    }
    clusters
}

/// Whether a tree is inside where these surfaces of its leaves are.
fn value(model: &Model, inside: &[Vec<bool>]) -> bool {
    let leaves: Vec<bool> =
        inside.iter().map(|surfaces| surfaces.iter().all(|&inside| inside)).collect();
    holds(model, &leaves)
}

impl Cluster {
    /// Finds out what happens in it, given on which surfaces' inner side the line is before.
    fn judge(&mut self, model: &Model, inside: &mut [Vec<bool>]) {
        /// More surfaces in one place are too many to try all orders.
        const MOST: usize = 6;
        let flip = |inside: &mut [Vec<bool>], set: usize| {
            for (i, &[leaf, surface]) in self.crossed.iter().take(MOST).enumerate() {
                inside[leaf][surface] ^= set >> i & 1 == 1;
            }
        };
        let all = (1 << self.crossed.len().min(MOST)) - 1;
        // The most changes on any way to where a set of surfaces has been crossed.
        let mut values = Vec::new();
        let mut changes: Vec<u32> = Vec::new();
        for set in 0..=all {
            flip(inside, set);
            values.push(value(model, inside));
            flip(inside, set);
            let from = (0..MOST).filter(|i| set >> i & 1 == 1).map(|i| set & !(1 << i));
            let step = |from| changes[from] + u32::from(values[from] != values[set]);
            changes.push(from.map(step).max().unwrap_or(0));
        }
        self.is_clear = self.crossed.len() <= MOST && changes[all] <= 1;
        self.before = value(model, inside);
        for &[leaf, surface] in &self.crossed {
            inside[leaf][surface] ^= true;
        }
        self.after = value(model, inside);
    }
}

impl Meeting {
    fn from(&self) -> f64 {
        self.t.rounded() - self.error
    }

    fn to(&self) -> f64 {
        self.t.rounded() + self.error
    }
}
