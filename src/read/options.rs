//! What a caller can choose.

use std::path::{Path, PathBuf};
use std::time::Duration;

/// How to read.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadOptions {
    /// What becomes of OpenSCAD's circles, cylinders and spheres.
    pub curves: Curves,
    /// Whose rules hold where versions of OpenSCAD differ.
    pub rules: Rules,
    /// The program that converts `.scad`; `openscad`, found on `PATH`, when there is none.
    pub openscad: Option<PathBuf>,
    /// How long that program may take over a file, and over each node that is left to it, before
    /// it is stopped.
    pub openscad_limit: Duration,
    /// The format; when there is none, the file's name tells.
    pub format: Option<Format>,
    /// Where the files may be that a `.csg` names. For `.scad` files it does not matter: the
    /// program that converts them reads what they name.
    pub imports: Imports,
    /// The most bytes that are read, of a file and all that it imports together. What is read
    /// takes at most some 20 times as much memory as its text.
    pub max_bytes: u64,
    /// The most triangles that are made of curves and polygons, of which a line of text can
    /// ask for any number. One takes some 130 bytes.
    pub max_facets: u64,
    /// How far facets may be from true curves where curves have no exact solid (in twisted
    /// extrusions, most hulls, sums, and circles that are turned about an axis), in model units.
    pub facet_tolerance: f64,
    /// The thickness that plane models get, from z = 0 up; without one they are refused.
    pub plate: Option<f64>,
    /// Whether what `%` and `#` mark in a `.csg` is read as well, into
    /// [`Model::marks`](super::Model::marks).
    pub marks: bool,
    /// Values for variables of `.scad` files, as `name=value` in OpenSCAD's language.
    pub definitions: Vec<String>,
    /// A file of OpenSCAD's customizer and the name of the set of parameters in it.
    pub parameters: Option<(PathBuf, String)>,
}

impl Default for ReadOptions {
    /// `Curves::Auto`; the rules of 2021; five minutes for OpenSCAD; imports from the model's folder;
    /// 1 GiB, which as binary `.stl` is 21 million triangles; 30 million
    /// facets; facets within 0.005 of what they stand for; and no marks.
    fn default() -> Self {
        Self {
            curves: Curves::default(),
            rules: Rules::default(),
            openscad: None,
            openscad_limit: Duration::from_secs(300),
            format: None,
            imports: Imports::default(),
            max_bytes: 1 << 30,
            max_facets: 30_000_000,
            facet_tolerance: 0.005,
            plate: None,
            marks: false,
            definitions: Vec::new(),
            parameters: None,
        }
    }
}

/// What becomes of OpenSCAD's circles, cylinders and spheres, which it defines as
/// polygons and polyhedra of `$fn` sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Curves {
    /// An explicit `$fn` up to 8 is taken as meant (a nut trap is a hexagon) and makes
    /// OpenSCAD's polygon; all others are true curves. Fractions of `$fn` are cut off.
    #[default]
    Auto,
    /// True curves throughout.
    Exact,
    /// OpenSCAD's vertices throughout.
    Faceted,
}

/// Which OpenSCAD's rules hold where its versions make different polyhedra of the same text. What
/// either of them writes is read with both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Rules {
    /// OpenSCAD 2021.01: a full `rotate_extrude` starts on −x if it does not say where, and of
    /// the sections of a part of a turn fractions are cut off, and with a twist uneven scale makes
    /// no more slices.
    #[default]
    V2021,
    /// OpenSCAD 2025.07: a `rotate_extrude` that says its angle starts on +x, the sections of
    /// a part of a turn are rounded up, and a `linear_extrude` with twist or uneven scale splits the
    /// edges of its outline.
    V2025,
}

/// Where the files may be that a model names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Imports {
    /// In the folder of the model, or in folders there.
    #[default]
    Folder,
    /// Anywhere: for models whose authors are trusted.
    Anywhere,
}

/// The formats that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// OpenSCAD's evaluated tree.
    Csg,
    /// OpenSCAD's language, converted by the installed program.
    Scad,
    /// Wavefront's mesh format.
    Obj,
    /// Stereolithography, as text or binary.
    Stl,
    /// The object file format of Geomview.
    Off,
    /// The 3D manufacturing format: an archive of objects.
    ThreeMf,
}

impl Format {
    /// The format that the ending of a file's name stands for.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "csg" => Some(Self::Csg),
            "scad" => Some(Self::Scad),
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "off" => Some(Self::Off),
            "3mf" => Some(Self::ThreeMf),
            _ => None,
        }
    }
}
