//! Embree: single precision, in a small program of C that is compiled on the spot.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};
use glam::DVec3;
use solidray::{Mesh, Ray};

/// The program, and what it is asked.
pub struct Embree {
    program: PathBuf,
    input: PathBuf,
}

/// Nanoseconds a ray, and how many hits or spans were found, by the names of queries.
pub type Answers = HashMap<String, (f64, f64)>;

impl Embree {
    /// Compiles the program, which needs a C compiler and Embree 3.
    pub fn new(folder: &Path) -> Result<Self> {
        let program = folder.join("embree");
        let source =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("children").join("embree.c");
        let status = Command::new("cc")
            .args(["-O3", "-march=native", "-o"])
            .args([&program, &source])
            .args(["-lembree3", "-lm"])
            .status()
            .context("there is no C compiler")?;
        ensure!(status.success(), "Embree 3 is not installed");
        Ok(Self { program, input: folder.join("rays") })
    }

    /// Writes what will be asked. The coherent rays are those of a square picture, row by
    /// row, and its side a multiple of four.
    pub fn prepare(
        &self,
        mesh: &Mesh,
        ball: (DVec3, f64),
        coherent: &[Ray],
        random: &[Ray],
    ) -> Result<()> {
        let mut file = BufWriter::new(File::create(&self.input)?);
        for count in
            [mesh.points().len(), mesh.faces().len(), coherent.len(), random.len()]
        {
            file.write_all(&u32::try_from(count)?.to_le_bytes())?;
        }
        let mut floats = |numbers: &[f64]| -> Result<()> {
            for &number in numbers {
                file.write_all(&(number as f32).to_le_bytes())?;
            }
            Ok(())
        };
        floats(&[ball.0.x, ball.0.y, ball.0.z, ball.1])?;
        for point in mesh.points() {
            floats(&point.to_array())?;
        }
        for index in mesh.faces().iter().flatten() {
            file.write_all(&index.to_le_bytes())?;
        }
        for ray in tiled(coherent).chain(random) {
            for number in [ray.origin, ray.dir].into_iter().flat_map(|v| v.to_array()) {
                file.write_all(&(number as f32).to_le_bytes())?;
            }
        }
        Ok(file.flush()?)
    }

    /// Builds and asks once.
    pub fn run(&self, robust: bool) -> Result<Answers> {
        let how = if robust { "robust" } else { "normal" };
        let said = Command::new(&self.program).arg(&self.input).arg(how).output()?;
        ensure!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
        let text = String::from_utf8(said.stdout)?;
        text.lines()
            .map(|line| {
                let words: Vec<&str> = line.split(' ').collect();
                let &[name, time, found] = &words[..] else { bail!("not {line}") };
                Ok((name.to_owned(), (time.parse()?, found.parse()?)))
            })
            .collect()
    }
}

/// The rays of a square picture in tiles of 4 by 4.
fn tiled(rays: &[Ray]) -> impl Iterator<Item = &Ray> {
    let side = rays.len().isqrt();
    let corners = (0..side)
        .step_by(4)
        .flat_map(move |y| (0..side).step_by(4).map(move |x| y * side + x));
    corners.flat_map(move |corner| {
        (0..16).map(move |k| &rays[corner + k / 4 * side + k % 4])
    })
}

/// Which Embree is installed, as its header tells.
pub fn version() -> Option<String> {
    let header = std::fs::read_to_string("/usr/include/embree3/rtcore_config.h").ok()?;
    let line = header.lines().find(|line| line.contains("RTC_VERSION_STRING"))?;
    Some(format!("Embree {}", line.split('"').nth(1)?))
}
