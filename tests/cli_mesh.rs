//! `solidray mesh`: files that are read back, and what is said of them.
#![cfg(feature = "cli")]

mod desk;

use std::fs;

use desk::{Desk, Done};
use serde_json::Value;
use solidray::measure::{self, Search};
use solidray::read::{self, ReadOptions};
use solidray::{Mesh, Part, Scene, Solid, View, facets, unwatched, write};

fn json(done: &Done) -> Value {
    serde_json::from_str(&done.out).unwrap_or_else(|e| panic!("{e}: {}", done.out))
}

fn read_back(desk: &Desk, name: &str) -> Mesh {
    let model = read::file(&desk.path(name), &ReadOptions::default()).expect("a mesh");
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let View::Mesh(mesh) = model.solid.view() else { panic!("{:?}", model.solid) };
    mesh.as_ref().clone()
}

#[test]
fn every_format_is_read_back_as_it_was_written() {
    let desk = Desk::new();
    for name in ["tube.stl", "tube.obj", "tube.off", "tube.3mf"] {
        let args = ["mesh", "tube.csg", "-o", name, "--tolerance=0.01", "--json"];
        let done = desk.run(&[&args[..], &["--lines=3000"]].concat());
        assert_eq!(done.code, 0, "{} {}", done.out, done.err);
        let (json, mesh) = (json(&done), read_back(&desk, name));
        assert_eq!(json["triangles"], mesh.faces().len());
        assert_eq!(json["points"], mesh.points().len());
        assert_eq!(json["bytes"], fs::read(desk.path(name)).expect("a file").len());
        let object = &json["objects"][0];
        let volume = object["volume"].as_f64().expect("a number");
        assert!((volume / mesh.volume() - 1.0).abs() < 1e-12, "{name}: {volume}");
        // 16 π times 10, and polygons have the area of circles.
        assert!((volume - 160.0 * std::f64::consts::PI).abs() < 1e-3, "{volume}");
        for way in ["from_mesh", "from_solid"] {
            let found = object[way]["largest_found"].as_f64().expect("a number");
            assert!(found > 0.002 && found <= 0.01, "{name}, {way}: {found}");
            assert!(json["largest_found"].as_f64() >= Some(found));
            assert_eq!(object[way]["lost"], 0);
        }
        let compared = desk.run(&["compare", "tube.csg", name, "--tol=4e-3"]);
        assert_eq!(compared.code, 0, "{}", compared.out);
    }
    // Readers may number points as they like.
    let texts = ["tube.obj", "tube.off", "tube.3mf"].map(|name| {
        let mesh = read_back(&desk, name);
        let mut points: Vec<_> = mesh.points().iter().map(|p| p.to_array()).collect();
        points.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
        points
    });
    assert_eq!(texts[0], texts[1], "all digits are there");
    assert_eq!(texts[0], texts[2], "all digits are there");
}

/// Tolerances are lengths of the model, however its leaves are scaled.
#[test]
fn facets_of_stretched_leaves_are_within_the_tolerance() {
    let desk = Desk::new();
    let text = "multmatrix([[50, 3, 0, 0], [0, 0.5, 0, 0], [0, 4, 2, 0], [0, 0, 0, 1]])
        sphere($fn = 0, $fa = 12, $fs = 2, r = 1);";
    desk.put("long.csg", text);
    let done = desk.run(&[
        "mesh",
        "long.csg",
        "-o",
        "long.obj",
        "--tolerance=0.02",
        "--json",
        "--lines=3000",
    ]);
    assert_eq!(done.code, 0, "{} {}", done.out, done.err);
    let volume = json(&done)["objects"][0]["volume"].as_f64().expect("a number");
    let expected = 4.0 / 3.0 * std::f64::consts::PI * 50.0;
    assert!((volume / expected - 1.0).abs() < 1e-9, "{volume}");
}

/// Two balls that all but touch the same circle from both sides: their edge is far from where it was.
#[test]
fn what_is_farther_than_the_tolerance_is_said() {
    let desk = Desk::new();
    let ball = "sphere($fn = 0, $fa = 12, $fs = 2, r = 3);";
    desk.put(
        "lens.csg",
        &format!(
            "difference() {{ {ball}
            multmatrix([[1, 0, 0, 0.02], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {ball} }}"
        ),
    );
    let args = ["mesh", "lens.csg", "-o", "lens.stl", "--tolerance=0.05", "--lines=3000"];
    let done = desk.run(&args);
    assert_eq!(done.code, 1, "{} {}", done.out, done.err);
    assert!(done.out.contains("farther than the tolerance"), "{}", done.out);
    assert!(desk.path("lens.stl").exists(), "it is written all the same");
}

/// Where nothing is looked at nothing is known.
#[test]
fn what_is_thinner_than_the_tolerance_is_not_within_it() {
    let desk = Desk::new();
    desk.put("sheet.csg", "cube(size = [10, 10, 0.0000001], center = false);");
    let args = ["mesh", "sheet.csg", "-o", "sheet.stl", "--lines=3000"];
    let done = desk.run(&[&args[..], &["--tolerance=0.1"]].concat());
    assert_eq!(done.code, 1, "{} {}", done.out, done.err);
    assert!(done.out.contains("too thin for this tolerance"), "{}", done.out);
    let done = desk.run(&[&args[..], &["--tolerance=0.000001"]].concat());
    assert_eq!(done.code, 0, "{} {}", done.out, done.err);
}

#[test]
fn standard_output_takes_the_mesh() {
    let desk = Desk::new();
    let done = desk.run(&[
        "mesh",
        "ball.csg",
        "-o",
        "-",
        "--to=off",
        "--tolerance=1",
        "--lines=0",
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(done.out.starts_with("OFF\n") && done.err.contains("triangles"));
    for (args, message) in [
        (&["-o", "-"][..], "standard output needs --to stl, obj, off or 3mf"),
        (&["-o", "-", "--to=off", "--json"], "cannot take both"),
        (&["-o", "ball.png"], "ball.png: meshes are written as .stl, .obj, .off or .3mf"),
        (&["-o", "ball"], "ball: meshes are written as .stl, .obj, .off or .3mf"),
        (&["-o", "ball.stl", "--to=obj"], "another format than --to says"),
        (&["-o", "no/ball.stl"], "there is no folder no"),
        (&["-o", "ball.stl", "--tolerance=1e-9"], "allow more with --max-triangles"),
        (&["-o", "ball.stl", "--tolerance=0"], "above zero"),
    ] {
        let done = desk.run(&[&["mesh", "ball.csg"], args].concat());
        assert_eq!(done.code, 2, "{args:?}");
        assert!((done.err + &done.out).contains(message), "{args:?}");
    }
    desk.put("nothing.csg", "union();");
    let done = desk.run(&["mesh", "nothing.csg", "-o", "nothing.stl"]);
    assert_eq!(done.code, 2);
    assert!(done.err.contains("the model is empty"), "{}", done.err);
    let left = fs::read_dir(desk.path("")).expect("the folder").count();
    assert_eq!(left, 3, "models alone");
}

/// At a rim the normal of one surface misses the other, which is near all the same.
#[test]
fn distances_are_those_of_the_nearest_points() {
    let scene = |solid: &Solid| Scene::compile(solid).expect("a solid");
    let apart = |a: &Solid, b: &Solid| {
        let search = Search { lines: 20_000, seed: 0, thinnest: 0.0 };
        measure::apart(&scene(a), &scene(b), &search, &unwatched)
    };
    let (wide, narrow) = (Solid::cylinder(5.0, 2.0), Solid::cylinder(4.9, 2.0));
    for found in [apart(&wide, &narrow), apart(&narrow, &wide)] {
        assert!(found.largest > 0.099 && found.largest < 0.101, "{found:?}");
        assert_eq!((found.lost, found.lines), (0, 20_000));
        assert!(found.points > 10_000);
    }
    // A cube in a larger one: from its corners it is no farther than from its faces; to its
    // corners it is.
    let [small, large] = [1.0, 1.2].map(|size| Solid::cuboid(glam::DVec3::splat(size)));
    assert!((apart(&small, &large).largest - 0.1).abs() < 1e-3);
    let farthest = apart(&large, &small).largest;
    assert!(farthest > 0.14 && farthest < 0.1 * 3.0_f64.sqrt() + 1e-3, "{farthest}");
    // One that is not there.
    let none = apart(&small, &Solid::empty());
    assert_eq!((none.lost, none.ends), (none.points, None));
    assert_eq!(apart(&Solid::empty(), &small).points, 0);
}

/// A slit is not there for whoever looks for wider ones, and neither is a sheet.
#[test]
fn what_is_too_thin_is_not_looked_at() {
    let sheet = Solid::cuboid(glam::dvec3(2.0, 2.0, 1e-9));
    let block = Solid::cuboid(glam::DVec3::splat(2.0));
    let far = sheet.clone().translated(glam::dvec3(0.0, 0.0, 9.0));
    let scene = |solid: &Solid| Scene::compile(solid).expect("a solid");
    let look = |thinnest| {
        let search = Search { lines: 3_000, seed: 0, thinnest };
        let odd = (block.clone() - sheet.clone()) + far.clone();
        measure::apart(&scene(&odd), &scene(&block), &search, &unwatched)
    };
    let (all, thick) = (look(0.0), look(1e-6));
    assert!(all.largest > 7.0 && all.thin == 0, "{all:?}");
    assert!(thick.largest < 1e-9 && thick.thin > 100, "{thick:?}");
    assert_eq!(all.points, thick.points + thick.thin);
}

/// A thin wedge beside a wide one: few directions lead from its side to where its edge was.
#[test]
fn wedges_are_near_where_their_edges_are() {
    // The bottom of the collar is just above the pipe, where that is flat.
    let wedge = |lift: f64| {
        let pipe = Solid::cylinder(10.0 - lift, 60.0);
        let collar = Solid::cuboid_between(
            glam::dvec3(9.0, -8.0, 20.0),
            glam::dvec3(14.0, 8.0, 40.0),
        );
        Scene::compile(&(pipe + collar)).expect("a solid")
    };
    let search = Search { lines: 100_000, seed: 0, thinnest: 0.0 };
    let found = measure::apart(&wedge(0.01), &wedge(0.0), &search, &unwatched);
    assert!(found.largest < 0.05, "{found:?}");
}

#[test]
fn surfaces_have_limits() {
    let ball = Solid::ball(1.0);
    let made = |tolerance, most| facets::surface(&ball, tolerance, most, &unwatched);
    assert!(matches!(
        made(1e-3, 100),
        Err(facets::FacetsError::TooMany { limit: 100, .. })
    ));
    assert_eq!(made(0.0, 100), Err(facets::FacetsError::BadTolerance(0.0)));
    assert!(made(f64::NAN, 100).is_err());
    let bowl = Solid::paraboloid(1.0, 1.0);
    let refused = facets::surface(&bowl, 0.1, 1000, &unwatched);
    assert_eq!(refused, Err(facets::FacetsError::NoFacets("paraboloid")));
    let below = Solid::half_space(glam::DVec3::Z, 0.5);
    let cut = facets::surface(&(ball.clone() & below.clone()), 0.1, 1000, &unwatched);
    assert!(cut.expect("a ball is bounded").is_some());
    let deep = Solid::half_space(glam::DVec3::Z, -1e9);
    let cut = facets::surface(&(ball.clone() & deep.clone()), 0.1, 1000, &unwatched);
    assert_eq!(cut, Ok(None));
    for endless in [
        below.clone(),
        ball.clone() + below.clone(),
        below.clone() - ball.clone(),
        ball.clone() + deep,
    ] {
        let refused = facets::surface(&endless, 0.1, 1000, &unwatched);
        assert_eq!(refused, Err(facets::FacetsError::Unbounded));
    }
    let nothing = ball.clone() - ball.clone();
    assert_eq!(facets::surface(&nothing, 0.1, 10_000, &unwatched), Ok(None));
}

/// A red ball in a blue block, which is without a colour where it is cut.
const PARTS: &str = "color([1, 0, 0, 1]) sphere($fn = 0, $fa = 12, $fs = 2, r = 3);
color([0, 0, 1, 0.5]) difference() {
\tcube(size = [8, 8, 8], center = true);
\tsphere($fn = 0, $fa = 12, $fs = 2, r = 3);
}
cylinder($fn = 0, $fa = 12, $fs = 2, h = 9, r1 = 1, r2 = 0, center = false);
";

#[test]
fn an_archive_has_an_object_for_each_part() {
    let desk = Desk::new();
    desk.put("parts.csg", PARTS);
    let args = ["mesh", "parts.csg", "--tolerance=0.05", "--lines=3000", "--json"];
    let done = desk.run(&[&args[..], &["-o", "parts.3mf"]].concat());
    assert_eq!(done.code, 0, "{} {}", done.out, done.err);
    let said = json(&done);
    let objects = said["objects"].as_array().expect("a list");
    let colors: Vec<_> = objects.iter().map(|o| o["color"].as_str()).collect();
    assert_eq!(colors, [Some("#ff0000"), Some("#0000ff80"), None]);
    let ball = objects[0]["volume"].as_f64().expect("a number");
    assert!((ball - 36.0 * std::f64::consts::PI).abs() < 1e-6, "{ball}");

    let model = read::file(&desk.path("parts.3mf"), &ReadOptions::default());
    let model = model.expect("our own file");
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let colors = |solid: &Solid| -> Vec<_> {
        let round = |c: solidray::Color| c.rgba.map(|x| (255.0 * x).round());
        solid.parts().iter().map(|(part, _)| part.color.map(round)).collect()
    };
    let red = Some([255.0, 0.0, 0.0, 255.0]);
    assert_eq!(colors(&model.solid), [red, Some([0.0, 0.0, 255.0, 128.0]), None]);
    let compared = desk.run(&["compare", "parts.csg", "parts.3mf", "--tol=5e-3"]);
    assert_eq!(compared.code, 0, "{}", compared.out);

    // The same bytes again, whatever the time and the number of threads.
    let done = desk.run(&[&args[..], &["-o", "again.3mf", "-j", "1"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let [first, again] = ["parts.3mf", "again.3mf"].map(|name| fs::read(desk.path(name)));
    assert!(first.expect("a file") == again.expect("a file"), "equal bytes");

    let done = desk.run(&[&args[..], &["-o", "one.3mf", "--one-object"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(json(&done)["objects"].as_array().map(Vec::len), Some(1));
    assert_eq!(colors(&Solid::mesh(read_back(&desk, "one.3mf"))), [None]);
}

/// What XML means by some characters is not what names mean by them.
#[test]
fn names_go_into_archives_and_come_back() {
    let desk = Desk::new();
    let mesh = facets::surface(&Solid::ball(1.0), 0.1, 1000, &unwatched);
    let mesh = mesh.expect("it has facets").expect("it is not empty");
    for name in ["<lid> & \"knob\"", "Gehäuse 盖", "it's"] {
        let part = Part { name: Some(name.into()), color: None };
        let bytes = write::archive(&[(part.clone(), &mesh)]).expect("an archive");
        fs::write(desk.path("named.3mf"), bytes).expect("a file");
        let model = read::file(&desk.path("named.3mf"), &ReadOptions::default());
        assert_eq!(model.expect("our own file").solid.parts()[0].0, part);
    }
    let part = Part { name: Some("a\u{1}b\u{0}".into()), color: None };
    let bytes = write::archive(&[(part, &mesh)]).expect("an archive");
    fs::write(desk.path("odd.3mf"), bytes).expect("a file");
    let model = read::file(&desk.path("odd.3mf"), &ReadOptions::default());
    let name = model.expect("our own file").solid.parts()[0].0.name.clone();
    assert_eq!(name.as_deref(), Some("ab"));
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_no_file() {
    use std::process::{Command, Stdio};
    let desk = Desk::new();
    let child = Command::new(env!("CARGO_BIN_EXE_solidray"))
        .args(["mesh", "tube.csg", "-o", "tube.stl", "--json", "--lines", "1000000000"])
        .current_dir(desk.path(""))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // Long enough for it to start on a busy machine.
    std::thread::sleep(std::time::Duration::from_secs(3));
    let kill = format!("kill -INT {}", child.id());
    let kill = Command::new("sh").args(["-c", &kill]).status();
    assert!(kill.expect("there is a shell").success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    let said = String::from_utf8(output.stdout).expect("text");
    assert!(said.contains("stopped, and nothing is written"), "{said}");
    let left = fs::read_dir(desk.path("")).expect("the folder").count();
    assert_eq!(left, 2, "models alone");
}
