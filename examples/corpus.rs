//! Volumes of a folder of OpenSCAD models beside those of a table.
//!
//! ```sh
//! cargo run --release --example corpus -- FOLDER [faceted|auto]
//! ```
//!
//! The table is `index.csv` or `references.csv` in the folder, with a column `file` or `name`, and
//! `volume_manifold` or `manifold` for OpenSCAD's facets, `volume_true_curves` or `closed` for true
//! curves. Without arguments it looks at the facets of the models of this repository.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use solidray::measure::{self, Estimate, Sampling};
use solidray::read::{self, Curves, ReadOptions};
use solidray::{CompileOptions, Scene};

/// How far volumes may be apart, relatively.
const AGREES: f64 = 3e-4;

/// A row of the table.
struct Row {
    file: String,
    feature: String,
    reference: Option<f64>,
}

/// The rows of a table.
fn rows(folder: &Path, curves: Curves) -> Result<Vec<Row>, Box<dyn Error>> {
    let table = ["index.csv", "references.csv"].map(|name| folder.join(name));
    let table = table.iter().find(|path| path.is_file());
    let table = table.ok_or("there is neither index.csv nor references.csv")?;
    let text = fs::read_to_string(table)?;
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let head: Vec<&str> = lines.next().ok_or("the table is empty")?.split(',').collect();
    let column = |names: &[&str]| head.iter().position(|name| names.contains(name));
    let file = column(&["file", "name"]).ok_or("no column `file`")?;
    let names: &[&str] = match curves {
        Curves::Faceted => &["volume_manifold", "manifold"],
        Curves::Auto | Curves::Exact => &["volume_true_curves", "closed"],
    };
    let reference = column(names).ok_or("no column of volumes")?;
    let feature = column(&["class"]);
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let text = |i: usize| (*fields.get(i).unwrap_or(&"")).to_owned();
        let name = text(file);
        Row {
            file: if name.ends_with(".csg") { name } else { name + ".csg" },
            feature: feature.map_or_else(|| "all".to_owned(), text),
            reference: text(reference).parse().ok(),
        }
    };
    Ok(lines.map(row).collect())
}

/// What came of a file.
struct Outcome {
    seconds: [f64; 2],
    volume: Result<Estimate, String>,
}

fn outcome(path: &Path, options: &ReadOptions) -> Outcome {
    let start = Instant::now();
    let scene = read::file(path, options).map_err(|error| error.to_string());
    let scene = scene.and_then(|model| {
        Scene::compile_with(&model.solid, &CompileOptions::default())
            .map_err(|error| error.to_string())
    });
    let read = start.elapsed().as_secs_f64();
    let sampling = Sampling {
        rel_tol: 2e-5,
        time_limit: Some(Duration::from_secs(10)),
        ..Sampling::default()
    };
    let volume = scene.map(|scene| measure::volume(&scene, &sampling));
    Outcome { seconds: [read, start.elapsed().as_secs_f64() - read], volume }
}

/// How many files of a feature there are, were read, have a reference, and agree with it.
#[derive(Clone, Copy, Default)]
struct Count {
    files: u32,
    read: u32,
    compared: u32,
    agree: u32,
}

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let folder = arguments.next().map_or(own, PathBuf::from);
    let curves = match arguments.next().as_deref() {
        None | Some("faceted") => Curves::Faceted,
        Some("auto") => Curves::Auto,
        Some(other) => {
            return Err(format!("`{other}` is neither faceted nor auto").into());
        }
    };
    let options = ReadOptions { curves, ..ReadOptions::default() };
    let mut counts: BTreeMap<String, Count> = BTreeMap::new();
    println!("| file | read, s | measured, s | volume | ± | reference | difference | |");
    println!("|---|---|---|---|---|---|---|---|");
    for Row { file, feature, reference } in rows(&folder, curves)? {
        let Outcome { seconds: [read, measured], volume } =
            outcome(&folder.join(&file), &options);
        let count = counts.entry(feature).or_default();
        count.files += 1;
        let found = match volume {
            Ok(found) => found,
            Err(error) => {
                println!("| {file} | {read:.2} | | | | | | not read: {error} |");
                continue;
            }
        };
        count.read += 1;
        print!(
            "| {file} | {read:.2} | {measured:.2} | {:.8e} | {:.1e} |",
            found.value,
            found.half_width()
        );
        let Some(reference) = reference else {
            println!(" | | |");
            continue;
        };
        count.compared += 1;
        let difference = found.value / reference - 1.0;
        let [low, high] = found.interval;
        let agrees = difference.abs() <= AGREES || (low..=high).contains(&reference);
        count.agree += u32::from(agrees);
        let verdict = if agrees { "" } else { "differs" };
        println!(" {reference:.8e} | {difference:+.1e} | {verdict} |");
    }
    println!();
    println!("| feature | files | read | with a reference | agree to {AGREES:.0e} |");
    println!("|---|---|---|---|---|");
    let mut all = Count::default();
    for (feature, count) in &counts {
        let Count { files, read, compared, agree } = *count;
        println!("| {feature} | {files} | {read} | {compared} | {agree} |");
        all.files += files;
        all.read += read;
        all.compared += compared;
        all.agree += agree;
    }
    let Count { files, read, compared, agree } = all;
    println!("| together | {files} | {read} | {compared} | {agree} |");
    Ok(())
}
