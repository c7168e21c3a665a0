//! How long scenes take to compile, and how much memory: `cargo bench --bench compile`.

#[expect(dead_code, reason = "what is only compiled is not looked at")]
#[path = "scenes/mod.rs"]
mod scenes;

use divan::{AllocProfiler, Bencher, black_box};
use scenes::{FORMULAS, MESHES, Subject};
use solidray::Scene;

/// Counts what is allocated.
#[global_allocator]
static ALLOCATOR: AllocProfiler = AllocProfiler::system();

fn main() {
    divan::main();
}

/// From what is said to a scene that answers.
#[divan::bench(args = FORMULAS.into_iter().chain(MESHES), sample_count = 7, sample_size = 1)]
fn compile(bencher: Bencher, name: &str) {
    let solid = Subject::named(name).solid;
    bencher
        .bench_local(|| Scene::compile(black_box(&solid)).expect("the scene is right"));
}
