//! The tables, one function each.

use std::hint::black_box;
use std::time::Instant;

use anyhow::{Result, ensure};
use fidget::raster::voxel::Image;
use solidray::measure::{self, Estimate, Sampling};
use solidray::render::{Frame, trace};
use solidray::{Mesh, Scene, Solid, View};

use crate::clock::{median, seconds};
use crate::embree::Embree;
use crate::facets::Facets;
use crate::part::Part;
use crate::report::{Table, number, ratio, reached};
use crate::scenes::Subject;
use crate::voxels::Voxels;
use crate::{Call, Run, goals, povray, queries, threads};

/// The side of pictures.
const SIZE: u32 = 1024;
/// The side of the grid of rays through meshes.
const GRID: u32 = 1024;
/// How many single rays are asked about.
const COUNT: u32 = 1 << 17;
/// How many points are asked about at once.
const POINTS: u32 = 1 << 20;
/// The most pixels that two programs may see differently.
const APART: f64 = 0.02;

const NANO: f64 = 1e9;

fn compiled(name: &str) -> Result<(Subject, Scene)> {
    let subject = Subject::named(name);
    let scene = Scene::compile(&subject.solid)?;
    Ok((subject, scene))
}

fn tree(subject: &Subject) -> Part {
    Part::of(&subject.solid).expect("the scene has no meshes")
}

/// Pictures of formulas.
pub fn primary(run: &Run) -> Result<Table> {
    let mut table = Table::new(
        "primary",
        &[
            "scene",
            "solidray, ns",
            "fidget, ns",
            "ratio",
            "POV-Ray, ns",
            "ratio",
            "floor",
            "goal",
            "reached",
        ],
    );
    for name in run.formulas() {
        let (subject, scene) = compiled(name)?;
        let (view, part) = (subject.view(SIZE), tree(&subject));
        let (center, half) = (subject.bounds.center(), subject.half_height);
        let voxels = (!run.args.no_fidget).then(|| Voxels::new(&part));
        if let Some(voxels) = &voxels {
            let frame = trace(&scene, &view, [0.5; 2], &|_| ());
            let apart = apart(&frame, &voxels.draw(&view, center, half)?);
            ensure!(apart < APART, "{name}: {apart} of the pixels differ from fidget's");
        }
        let rays = f64::from(SIZE) * f64::from(SIZE);
        let picture = || run.one.install(|| queries::normals(&scene, &view));
        let ours: Call<'_> = Box::new(|| Ok(seconds(picture)? * NANO / rays));
        let drawn = voxels.as_ref().map(|voxels| -> Call<'_> {
            Box::new(|| Ok(seconds(|| voxels.draw(&view, center, half))? * NANO / rays))
        });
        let [ours, fidget] = run.in_turns([Some(ours), drawn])?;
        let ours = ours.unwrap_or(f64::NAN);
        let povray = if run.args.no_povray {
            None
        } else {
            let text = |size| povray::source(&part, &subject.view(size), center, half);
            Some(povray_nanos(&povray::save(&text(SIZE), run.folder.path())?, run)?)
        };
        let (goal, floor) = (goals::primary(name), goals::faster_than_fidget(name));
        table.row(vec![
            name.to_owned(),
            number(Some(ours)),
            number(fidget),
            ratio(fidget, ours),
            povray.map_or_else(
                || number(None),
                |(time, size)| {
                    let at =
                        if size == SIZE { String::new() } else { format!(" ({size}²)") };
                    number(Some(time)) + &at
                },
            ),
            ratio(povray.map(|(time, _)| time), ours),
            format!("{floor}× fidget"),
            ratio(goal.map(|goal| goal.faster()), 1.0),
            reached(
                goal.zip(fidget).map(|(goal, time)| time >= goal.faster() * ours),
                fidget.map(|time| time >= floor * ours),
            ),
        ]);
    }
    Ok(table)
}

/// The part of the pixels that hit in one picture and miss in the other.
fn apart(frame: &Frame, image: &Image) -> f64 {
    let pixels = (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y)));
    let differ = pixels
        .zip(image.as_slice())
        .filter(|((x, y), pixel)| frame.hit(*x, *y).is_some() != (pixel.depth > 0))
        .count();
    differ as f64 / image.as_slice().len() as f64
}

/// Nanoseconds a ray, and the side of the largest picture that does not take too long.
fn povray_nanos(source: &std::path::Path, run: &Run) -> Result<(f64, u32)> {
    const LEAST: u32 = 8;
    let reading = povray::seconds(source, LEAST)?;
    let nanos = |size: u32| -> Result<f64> {
        let rays = size.pow(2) - LEAST.pow(2);
        Ok((povray::seconds(source, size)? - reading) * NANO / f64::from(rays))
    };
    let guess = nanos(64)?;
    let most = run.args.patience * NANO / guess.max(1.0);
    let mut size = SIZE;
    while f64::from(size).powi(2) > most && size > 64 {
        size /= 2;
    }
    Ok((nanos(size)?, size))
}

/// How cost grows, compiling, and threads.
pub fn growth(run: &Run) -> Result<Table> {
    let mut table = Table::new("growth", &["what", "measured", "floor", "reached"]);
    for kind in ["spheres", "plate"].into_iter().filter(|kind| run.asked(kind)) {
        let [few, many] = ["1k", "10k"].map(|count| compiled(&format!("{kind}-{count}")));
        let (few, many) = (few?, many?);
        let picture = |(subject, scene): &(Subject, Scene)| {
            let view = subject.view(SIZE);
            seconds(|| run.one.install(|| queries::normals(scene, &view)))
        };
        let calls: [Option<Call<'_>>; 3] = [
            Some(Box::new(|| picture(&few))),
            Some(Box::new(|| picture(&many))),
            Some(Box::new(|| seconds(|| Scene::compile(&many.0.solid)))),
        ];
        let [small, large, compile] = run.in_turns(calls)?.map(|t| t.unwrap_or(f64::NAN));
        table.row(vec![
            format!("ray of a picture, {kind}-10k to {kind}-1k"),
            ratio(Some(large), small),
            format!("< {}×", goals::GROWTH),
            reached(None, Some(large < goals::GROWTH * small)),
        ]);
        table.row(vec![
            format!("compiling {kind}-10k"),
            format!("{} ms", number(Some(1e3 * compile))),
            format!("< {} ms", goals::COMPILE),
            reached(None, Some(1e3 * compile < goals::COMPILE)),
        ]);
        let two = threads(2)?;
        let (subject, scene) = &many;
        let view = subject.view(SIZE);
        let sampling = Sampling { rel_tol: 1e-4, ..Sampling::default() };
        let wall = |pool: &rayon::ThreadPool, call: &(dyn Fn() + Sync)| {
            let start = Instant::now();
            pool.install(call);
            Ok(start.elapsed().as_secs_f64())
        };
        let picture = || {
            black_box(queries::normals(scene, &view));
        };
        let measured = || {
            black_box(measure::volume(scene, &sampling));
        };
        for (what, call) in
            [("picture", &picture as &(dyn Fn() + Sync)), ("volume", &measured)]
        {
            let calls: [Option<Call<'_>>; 2] = [
                Some(Box::new(|| wall(&run.one, call))),
                Some(Box::new(|| wall(&two, call))),
            ];
            let [one, two] = run.in_turns(calls)?.map(|t| t.unwrap_or(f64::NAN));
            table.row(vec![
                format!("two threads, {what} of {kind}-10k, wall clock"),
                ratio(Some(one), two),
                format!("≥ {}×", goals::TWO_THREADS),
                reached(None, Some(one >= goals::TWO_THREADS * two)),
            ]);
        }
    }
    Ok(table)
}

/// Rays through meshes.
pub fn meshes(run: &Run) -> Result<Table> {
    let mut table = Table::new(
        "meshes",
        &[
            "scene and query",
            "solidray, ns",
            "Embree, ns",
            "Embree robust, ns",
            "Embree / solidray",
            "floor",
            "goal",
            "solidray / floor",
            "reached",
        ],
    );
    let names: Vec<_> = run.meshes().collect();
    let wanted = !run.args.no_embree && !names.is_empty();
    let embree = wanted.then(|| Embree::new(run.folder.path())).transpose()?;
    for name in names {
        let (subject, scene) = compiled(name)?;
        let view = subject.view(GRID);
        let parallel = queries::parallel(&view);
        let random = queries::chords(&subject.bounds, COUNT);
        if let Some(embree) = &embree {
            let ball = (glam::dvec3(0.55, 0.45, 0.6), 0.6);
            embree.prepare(mesh(&subject.solid)?, ball, &parallel, &random)?;
        }
        let mut tracer = scene.tracer();
        let [mut ours, mut plain, mut robust] =
            [(); 3].map(|()| [(); 4].map(|()| Vec::new()));
        let count = parallel.len() as f64;
        for _ in 0..run.args.rounds.max(1) {
            let picture =
                seconds(|| run.one.install(|| trace(&scene, &view, [0.5; 2], &|_| ())))?;
            let single = seconds(|| queries::first(&mut tracer, &parallel))?;
            let jumping = seconds(|| queries::first(&mut tracer, &random))?;
            let all = seconds(|| queries::spans(&mut tracer, &parallel))?;
            let rays = random.len() as f64;
            let times = [picture / count, single / count, jumping / rays, all / count];
            for (of, time) in ours.iter_mut().zip(times) {
                of.push(NANO * time);
            }
            let Some(embree) = &embree else { continue };
            for (is_robust, times) in [(false, &mut plain), (true, &mut robust)] {
                let found = embree.run(is_robust)?;
                for (of, query) in
                    times.iter_mut().zip(["packets", "coherent", "random", "all"])
                {
                    of.extend(found.get(query).map(|(time, _)| *time));
                }
                let theirs = found.get("all").map_or(0.0, |(_, spans)| *spans);
                let ours = queries::spans(&mut tracer, &parallel) as f64;
                ensure!(
                    (theirs / ours - 1.0).abs() < APART,
                    "{name}: {ours} spans, and {theirs} by Embree"
                );
            }
        }
        let queries = [
            "picture, packets of 16 rays",
            "first hit, single rays",
            "first hit, random rays",
            "all spans",
        ];
        let [ours, plain, robust] = [ours, plain, robust].map(|of| of.map(median));
        for (i, query) in queries.into_iter().enumerate() {
            let time = ours[i].unwrap_or(f64::NAN);
            // The first query has single rays for its floor too.
            let (limit, floor) = if i == 3 {
                (robust[3], "< robust".to_owned())
            } else {
                let limit = plain[i.max(1)].map(|t| goals::OF_EMBREE * t);
                (limit, format!("{}× Embree's single rays", goals::OF_EMBREE))
            };
            let goal = goals::mesh(name)[i];
            table.row(vec![
                format!("{name}, {query}"),
                number(Some(time)),
                number(plain[i]),
                number(robust[i]),
                ratio(plain[i], time),
                floor,
                ratio(Some(goal.faster()), 1.0),
                limit.map_or_else(|| number(None), |limit| ratio(Some(time), limit)),
                reached(
                    plain[i].map(|theirs| theirs >= goal.faster() * time),
                    limit.map(|limit| time <= limit),
                ),
            ]);
        }
    }
    Ok(table)
}

/// The mesh that something is subtracted from.
fn mesh(solid: &Solid) -> Result<&Mesh> {
    let mut solid = solid;
    loop {
        solid = match solid.view() {
            View::Mesh(mesh) => return Ok(mesh),
            View::Boolean(_, [first, ..]) => first,
            _ => anyhow::bail!("the scene has no mesh"),
        }
    }
}

/// Points.
pub fn membership(run: &Run) -> Result<Table> {
    let mut table = Table::new(
        "membership",
        &["scene", "solidray, ns", "fidget, ns", "ratio", "floor", "goal", "reached"],
    );
    for name in run.formulas().chain(run.meshes()) {
        let (subject, scene) = compiled(name)?;
        let points = queries::points(&subject.bounds, POINTS);
        let count = f64::from(POINTS);
        let voxels = match Part::of(&subject.solid) {
            Some(part) if !run.args.no_fidget => Some(Voxels::new(&part)),
            _ => None,
        };
        let single = [0, 1, 2].map(|axis| -> Vec<f32> {
            points.iter().map(|point| point[axis] as f32).collect()
        });
        if let Some(voxels) = &voxels {
            let [a, b] = [queries::inside(&scene, &points), voxels.inside(&single)?];
            ensure!(a.abs_diff(b) as f64 <= 1e-3 * count, "{name}: {a} and {b} inside");
        }
        let ours: Call<'_> =
            Box::new(|| Ok(seconds(|| queries::inside(&scene, &points))? * NANO / count));
        let bulk = voxels.as_ref().map(|voxels| -> Call<'_> {
            Box::new(|| Ok(seconds(|| voxels.inside(&single))? * NANO / count))
        });
        let [ours, fidget] = run.in_turns([Some(ours), bulk])?;
        let ours = ours.unwrap_or(f64::NAN);
        let floor = goals::yardstick(name).map_or(1.0, |floor| floor.faster());
        let goal = goals::membership(name).map(|goal| goal.faster());
        table.row(vec![
            name.to_owned(),
            number(Some(ours)),
            number(fidget),
            ratio(fidget, ours),
            fidget.map_or_else(|| number(None), |_| ratio(Some(floor), 1.0)),
            ratio(goal, 1.0),
            reached(
                goal.zip(fidget).map(|(goal, time)| time >= goal * ours),
                fidget.map(|time| time >= floor * ours),
            ),
        ]);
    }
    Ok(table)
}

/// Volumes to one part in ten thousand.
pub fn volume(run: &Run) -> Result<Table> {
    const ERROR: f64 = 1e-4;
    /// How many rays it takes depends on the seed.
    const SEEDS: u64 = 8;
    let mut table = Table::new(
        "volume",
        &[
            "scene",
            "solidray, ms",
            "and compiling, ms",
            "Manifold, ms",
            "its last measurement",
            "ratio",
            "floor",
            "goal",
            "reached",
        ],
    );
    for (name, known, goal, floor) in goals::VOLUMES {
        if !run.asked(name) {
            continue;
        }
        let (subject, scene) = compiled(name)?;
        let exact = subject.volume.or(known).expect("the volume is known");
        let ask = |seed| -> Estimate {
            let sampling = Sampling { rel_tol: ERROR, seed, ..Sampling::default() };
            run.one.install(|| measure::volume(&scene, &sampling))
        };
        for found in (0..SEEDS).map(ask) {
            ensure!(found.target_met, "{name}: {found:?}");
            ensure!((found.value / exact - 1.0).abs() < 3.0 * ERROR, "{name}: {found:?}");
        }
        let calls: [Option<Call<'_>>; 2] = [
            Some(Box::new(|| {
                let all = seconds(|| {
                    for seed in 0..SEEDS {
                        black_box(ask(seed));
                    }
                })?;
                Ok(1e3 * all / SEEDS as f64)
            })),
            Some(Box::new(|| Ok(1e3 * seconds(|| Scene::compile(&subject.solid))?))),
        ];
        let [ours, compiling] = run.in_turns(calls)?.map(|t| t.unwrap_or(f64::NAN));
        let whole = ours + compiling;
        let manifold = if run.args.no_manifold {
            None
        } else {
            let facets =
                Facets::new(&tree(&subject), &run.args.python, run.folder.path())?;
            Some(facets.time_to(ERROR, exact, run.args.patience)?)
        };
        let theirs = manifold.as_ref().map(|found| 1e3 * found.seconds);
        let last = manifold.as_ref().map(|found| {
            let (segments, seconds, error) = found.last;
            let how = if found.extrapolated { ", extrapolated" } else { "" };
            format!("{segments} segments, {error:.1e}, {} s{how}", number(Some(seconds)))
        });
        let met = theirs.zip(floor).map(|(time, floor)| time >= floor * whole);
        table.row(vec![
            name.to_owned(),
            number(Some(ours)),
            number(Some(whole)),
            number(theirs),
            last.unwrap_or_else(|| number(None)),
            ratio(theirs, whole),
            floor.map_or_else(|| number(None), |floor| format!("{floor}× Manifold")),
            ratio(Some(goal.faster()), 1.0),
            reached(theirs.map(|time| time >= goal.faster() * whole), met),
        ]);
    }
    Ok(table)
}
