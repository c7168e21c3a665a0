//! The largest models: how long they take and how much memory at most.
//!
//! `cargo run --release --example large`
//!
//! Each case runs in a process of its own, on a stack of 256 KiB, from what is said or
//! written to the last answer and the end. Memory is the high-water mark that Linux keeps.

use std::error::Error;
use std::f64::consts::TAU;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use glam::{DVec3, dvec3};
use solidray::read::{self, ReadOptions};
use solidray::{Op, Ray, Scene, Solid};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// A model to build or to read.
struct Case {
    name: &'static str,
    /// How many items it has, and what an item is.
    items: u32,
    item: &'static str,
    /// How many bytes an item may take beyond the file it is read from.
    most: u64,
}

const CASES: [Case; 4] = [
    Case { name: "union", items: 1_000_000, item: "leaf", most: 1_300 },
    Case { name: "chain", items: 100_000, item: "leaf", most: 1_500 },
    Case { name: "binary.stl", items: 4_999_122, item: "triangle", most: 130 },
    Case { name: "text.stl", items: 4_999_122, item: "triangle", most: 130 },
];

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn main() -> Result<()> {
    let asked = std::env::args().nth(1);
    for case in &CASES {
        match &asked {
            Some(name) if name == case.name => return run(case),
            Some(_) => continue,
            None => {}
        }
        let status = Command::new(std::env::current_exe()?).arg(case.name).status()?;
        if !status.success() {
            return Err(format!("{}: {status}", case.name).into());
        }
    }
    println!("all within their bounds");
    Ok(())
}

/// Runs a case where a frame of the stack for each item would not fit.
fn run(case: &'static Case) -> Result<()> {
    let small = std::thread::Builder::new().stack_size(256 * 1024);
    let done = small.spawn(move || measured(case).map_err(|e| e.to_string()))?;
    Ok(done.join().map_err(|_| "the thread panicked")??)
}

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn measured(case: &Case) -> Result<()> {
    let Case { name, items, item, most } = *case;
    let file =
        std::env::temp_dir().join(format!("solidray-{}-{name}", std::process::id()));
    let written =
        if name.ends_with(".stl") { write_torus(&file, name == "text.stl")? } else { 0 };
    let before = peak_bytes();
    let start = Instant::now();
    let solid = match name {
        "union" => Solid::boolean(Op::Union, (0..items).map(pearl)),
        "chain" => {
            let low = dvec3(-1.0, -1.0, -1.0);
            let plate = Solid::cuboid_between(low, dvec3(1000.0, 1000.0, 1.0));
            (0..items).fold(plate, |rest, i| rest - pearl(i))
        }
        _ => {
            let model = read::file(&file, &ReadOptions::default());
            std::fs::remove_file(&file)?;
            model?.solid
        }
    };
    let said = start.elapsed();
    let scene = Scene::compile(&solid)?;
    let compiled = start.elapsed();
    let mut tracer = scene.tracer();
    let (size, center) = (scene.bounds().size(), scene.bounds().center());
    let hits = (0..5_000_u32)
        .map(|i| center + 0.5 * size * (cell(i * 997 % 1_000_000) / 500.0 - 1.0))
        .filter(|&p| !tracer.spans(&Ray::new(p, dvec3(0.3, 1.0, 0.2))).is_empty())
        .count();
    let inside = (0..5_000).filter(|&i| tracer.contains(cell(i))).count();
    let asked = start.elapsed();
    drop(scene);
    drop(solid);
    let dropped = start.elapsed();
    let took = peak_bytes().zip(before).map(|(peak, before)| peak.saturating_sub(before));
    let [a, b, c] = [compiled - said, asked - compiled, dropped - asked];
    println!(
        "{name}: {items} × {item}: {said:.2?} to say or read, {a:.2?} to compile, {b:.2?} for \
         10000 questions ({hits} hits, {inside} inside), {c:.2?} to drop"
    );
    if let Some(took) = took {
        let each = took / u64::from(items);
        println!(
            "    {each} bytes a {item} at most, of which the file has {}",
            written / u64::from(items)
        );
        let limit = most + written / u64::from(items);
        if each > limit {
            return Err(
                format!("{name}: {each} bytes a {item}, more than {limit}").into()
            );
        }
    }
    Ok(())
}

/// Place `i` on a square grid of a million cells.
fn cell(i: u32) -> DVec3 {
    dvec3(f64::from(i % 1000), f64::from(i / 1000), 0.0)
}

fn pearl(i: u32) -> Solid {
    Solid::ball(0.25).translated(cell(i))
}

/// A torus of 1581² squares, two triangles each; how many bytes that makes.
fn write_torus(path: &Path, as_text: bool) -> Result<u64> {
    const STEPS: u32 = 1581;
    let point = |i: u32, j: u32| {
        let [u, v] = [i, j].map(|k| f64::from(k % STEPS) / f64::from(STEPS) * TAU);
        let radius = 3.0 + v.cos();
        dvec3(radius * u.cos(), radius * u.sin(), v.sin()).as_vec3()
    };
    let mut file = BufWriter::new(File::create(path)?);
    if as_text {
        writeln!(file, "solid torus")?;
    } else {
        file.write_all(&[b' '; 80])?;
        file.write_all(&(2 * STEPS * STEPS).to_le_bytes())?;
    }
    for (i, j) in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (i, j))) {
        let [a, b] = [point(i, j), point(i + 1, j)];
        let [c, d] = [point(i + 1, j + 1), point(i, j + 1)];
        for triangle in [[a, b, c], [a, c, d]] {
            if as_text {
                writeln!(file, "  facet normal 0 0 0\n    outer loop")?;
                for p in triangle {
                    writeln!(file, "      vertex {:e} {:e} {:e}", p.x, p.y, p.z)?;
                }
                writeln!(file, "    endloop\n  endfacet")?;
            } else {
                file.write_all(&[0; 12])?;
                for x in triangle.iter().flat_map(|p| p.to_array()) {
                    file.write_all(&x.to_le_bytes())?;
                }
                file.write_all(&[0; 2])?;
            }
        }
    }
    if as_text {
        writeln!(file, "endsolid torus")?;
    }
    file.flush()?;
    Ok(std::fs::metadata(path)?.len())
}

/// The most memory that this process has held so far, where the system tells.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(1024 * kib)
}
