//! `solidray mesh`

mod look;
mod report;

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::bail;
use clap::{Args, ValueEnum};
use serde::Serialize;
use solidray::write::{self, Format};
use solidray::{Part, Scene, Solid, facets};

use super::input::Reading;
use super::interrupt::{self, interrupted};
use super::meter::Meter;
use super::output;
use super::pieces::label;
use super::report::note;
use super::sampling::positive;
use super::{Answer, Global};
use look::{Look, Looked};
use report::Written;

/// Write a closed mesh, for printing
///
/// Balls, cylinders and cones become polyhedra of the same volume with facets that are within
/// half the tolerance of them; what is united, subtracted and intersected of these is found by the
/// Manifold library. Where surfaces meet at a small angle, facets move the edge between them farther
/// than themselves. So rays look how far the mesh is from the solid, and the solid from the
/// mesh: what they find is the largest distance at so many points, not a bound. Walls and gaps
/// thinner than a hundredth of the tolerance are counted, and not looked at.
///
/// A .3mf has an object for each part, which is what shares a name or a colour; parts that overlap
/// do so there. Other formats have one mesh of the whole, without colours.
///
/// The exit code is 0 if nothing was found farther away than the tolerance, 1 if something was, or
/// all is too thin (the file is written all the same), and 2 if there is no mesh. The file is written in the end:
/// Ctrl-C leaves none.
#[derive(Args, Debug)]
pub(super) struct Mesh {
    /// The model
    file: PathBuf,
    /// The mesh to write, an .stl, .obj, .off or .3mf; or - for standard output, with --to
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// How far the mesh may be from the model [default: 1/2000 of the diagonal of the model's bounds]
    #[arg(long, value_name = "LENGTH", value_parser = positive)]
    tolerance: Option<f64>,
    /// The format to write, where the name of the output does not tell it
    #[arg(long, value_enum)]
    to: Option<To>,
    /// Write one object, without name and colour, whatever parts there are
    #[arg(long)]
    one_object: bool,
    /// Make no more triangles than this, also on the way; a million of them take about 400 MB
    #[arg(long, value_name = "TRIANGLES", default_value_t = 5_000_000)]
    max_triangles: u64,
    /// How many random lines through the solid, and through the mesh, look for points that are
    /// far apart; 0 for a mesh that is not looked at
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(..=1_000_000_000))]
    lines: u64,
    /// Which random numbers: equal seeds give equal answers, bit by bit
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    reading: Reading,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum To {
    /// binary STL: 7 digits, what slicers read
    Stl,
    /// Wavefront's: all digits
    Obj,
    /// Geomview's: all digits
    Off,
    /// an archive of objects with names and colours: all digits, in millimetres
    #[value(name = "3mf")]
    ThreeMf,
}

impl From<To> for Format {
    fn from(to: To) -> Self {
        match to {
            To::Stl => Self::Stl,
            To::Obj => Self::Obj,
            To::Off => Self::Off,
            To::ThreeMf => Self::ThreeMf,
        }
    }
}

/// The default tolerance as a part of the diagonal.
const PART: f64 = 1.0 / 2000.0;

/// The part of the tolerance that facets have. Where surfaces meet at right angles their edge moves
/// by √2 of what each of them does, and by twice as much at 60°.
const OF_FACETS: f64 = 0.5;

/// The part of the tolerance that walls and gaps have which are not looked at.
const OF_THIN: f64 = 0.01;

/// A mesh that is written, and what is known of it.
struct Object {
    part: Part,
    mesh: solidray::Mesh,
    /// Nothing if nobody looked.
    looked: Option<Looked>,
}

#[derive(Clone, Copy, Serialize)]
struct Seconds {
    read: f64,
    compile: f64,
    mesh: f64,
    look: f64,
    write: f64,
}

impl Mesh {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        let format = self.format()?;
        if self.is_to_standard_output() && global.json {
            bail!("standard output cannot take both the mesh and --json");
        }
        let (loaded, solid) = self.reading.load_and_keep(&self.file, global)?;
        let tolerance = self.tolerance(&loaded.scene)?;
        interrupt::watch()?;
        let start = Instant::now();
        let (mut objects, pieces) = self.objects(&solid, format, tolerance, global)?;
        let mesh = start.elapsed().as_secs_f64();
        let start = Instant::now();
        if self.lines > 0 {
            let look = Look {
                lines: self.lines.div_ceil(objects.len() as u64),
                seed: self.seed,
                thinnest: OF_THIN * tolerance,
                compiling: self.reading.compiling(),
                global,
            };
            if let [object] = &mut objects[..] {
                object.looked = Some(look.at(&loaded.scene, &object.mesh)?);
            } else {
                for (object, piece) in objects.iter_mut().zip(&pieces) {
                    let scene = self.reading.compile(&self.file, piece)?;
                    object.looked = Some(look.at(&scene, &object.mesh)?);
                }
            }
        }
        let look = start.elapsed().as_secs_f64();
        if interrupted() {
            bail!("{}: stopped, and nothing is written", self.file.display());
        }
        let start = Instant::now();
        let bytes = match (format, &objects[..]) {
            (Format::ThreeMf, objects) => {
                let objects = objects.iter().map(|o| (o.part.clone(), &o.mesh));
                write::archive(&objects.collect::<Vec<_>>())?
            }
            (format, objects) => write::bytes(&objects[0].mesh, format)?,
        };
        if self.is_to_standard_output() {
            out.write_all(&bytes)?;
            out.flush()?;
        } else {
            output::save(&self.output, &bytes)?;
        }
        let seconds = Seconds {
            read: loaded.read_seconds,
            compile: loaded.compile_seconds,
            mesh,
            look,
            write: start.elapsed().as_secs_f64(),
        };
        let output = self.output.display().to_string();
        let written = Written { output, bytes: bytes.len(), tolerance, objects, seconds };
        if global.json {
            output::json(out, written.report())?;
        } else if !self.is_to_standard_output() {
            for line in written.lines(global) {
                writeln!(out, "{line}")?;
            }
        } else if !global.quiet {
            written.lines(global).iter().for_each(|line| note(line));
        }
        Ok(if written.is_within() == Some(false) { Answer::No } else { Answer::Yes })
    }

    fn is_to_standard_output(&self) -> bool {
        self.output.as_os_str() == "-"
    }

    /// What is written, and what would only be found out after the work.
    fn format(&self) -> anyhow::Result<Format> {
        /// The formats as messages list them.
        const FORMATS: &str = ".stl, .obj, .off or .3mf";
        let path = self.output.display();
        let folder = self.output.parent().filter(|f| !f.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
            bail!("{path}: there is no folder {}", folder.display());
        }
        let named = Format::of(&self.output);
        match (self.to.map(Format::from), named) {
            (Some(to), Some(named)) if to != named => {
                bail!("{path}: the name is that of another format than --to says")
            }
            (Some(format), _) | (None, Some(format)) => Ok(format),
            (None, None) if self.is_to_standard_output() => {
                bail!("standard output needs --to stl, obj, off or 3mf")
            }
            (None, None) => {
                bail!("{path}: meshes are written as {FORMATS}; --to chooses one")
            }
        }
    }

    fn tolerance(&self, scene: &Scene) -> anyhow::Result<f64> {
        let bounds = scene.bounds();
        if bounds.is_empty() {
            bail!("{}: the model is empty, and so is its mesh", self.file.display());
        }
        if !bounds.is_bounded() {
            bail!("{}: the model has no bounds, and a mesh has", self.file.display());
        }
        Ok(self.tolerance.unwrap_or(PART * bounds.size().length()))
    }

    /// The meshes, as the format rounds them, and the solids of which they are.
    fn objects(
        &self,
        solid: &Solid,
        format: Format,
        tolerance: f64,
        global: Global,
    ) -> anyhow::Result<(Vec<Object>, Vec<Solid>)> {
        let name = self.file.display();
        let pieces = if format == Format::ThreeMf && !self.one_object {
            solid.parts()
        } else {
            vec![(Part::default(), solid.clone())]
        };
        let (mut objects, mut kept, mut triangles) = (Vec::new(), Vec::new(), 0);
        for (part, piece) in pieces {
            let room = self.max_triangles.saturating_sub(triangles);
            let Some(mesh) = self.surface(&piece, tolerance, room, global)? else {
                if !global.quiet {
                    let part = label(&part);
                    note(&format!(
                        "warning: {name}: there is nothing of the part {part}"
                    ));
                }
                continue;
            };
            let mesh = write::rounded(&mesh, format)?;
            triangles += mesh.faces().len() as u64;
            objects.push(Object { part, mesh, looked: None });
            kept.push(piece);
        }
        if objects.is_empty() {
            bail!("{name}: the model is empty, or facets so coarse leave nothing of it");
        }
        Ok((objects, kept))
    }

    fn surface(
        &self,
        solid: &Solid,
        tolerance: f64,
        most_triangles: u64,
        global: Global,
    ) -> anyhow::Result<Option<solidray::Mesh>> {
        let meter = Meter::of_triangles(global, "combining");
        let watch = |triangles| meter.step(triangles);
        let aim = OF_FACETS * tolerance;
        let surface = facets::surface(solid, aim, most_triangles, &watch);
        let hint = match surface {
            Err(facets::FacetsError::TooMany { .. }) => {
                ": allow more with --max-triangles, or a larger --tolerance"
            }
            Ok(_) | Err(_) => "",
        };
        surface.map_err(|error| anyhow::anyhow!("{}: {error}{hint}", self.file.display()))
    }
}
