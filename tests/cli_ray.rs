//! `solidray ray` in scripts: grids, tables and lines of JSON.
#![cfg(feature = "cli")]

mod desk;

use desk::{Desk, Done};

fn lines(done: &Done) -> Vec<&str> {
    assert_eq!(done.code, 0, "{}", done.err);
    done.out.lines().collect()
}

#[test]
fn a_grid_along_an_axis_starts_at_the_box() {
    let desk = Desk::new();
    let columns = ["--columns", "ray,ox,oy,oz,dx,dy,dz,t_in,t_out"];
    let grid = |along| ["ray", "tube.csg", "--grid", "5,1", "--along", along];
    let done = desk.run(&[&grid("z")[..], &columns].concat());
    // The middle one passes the bore.
    let expected = [
        "ray,ox,oy,oz,dx,dy,dz,t_in,t_out",
        "0,-4.0,0.0,0.0,0.0,0.0,1.0,0.0,10.0",
        "4,4.0,0.0,0.0,0.0,0.0,1.0,0.0,10.0",
    ];
    assert_eq!(lines(&done), expected);
    let done = desk.run(&[&grid("-x")[..], &columns].concat());
    let expected = [
        "0,5.0,-4.0,5.0,-1.0,0.0,0.0,2.0,8.0",
        "1,5.0,-2.0,5.0,-1.0,0.0,0.0,",
        "1,5.0,-2.0,5.0,-1.0,0.0,0.0,",
        "2,5.0,0.0,5.0,-1.0,0.0,0.0,0.0,2.0",
        "2,5.0,0.0,5.0,-1.0,0.0,0.0,8.0,10.0",
        "3,5.0,2.0,5.0,-1.0,0.0,0.0,",
        "3,5.0,2.0,5.0,-1.0,0.0,0.0,",
        "4,5.0,4.0,5.0,-1.0,0.0,0.0,2.0,8.0",
    ];
    let found = lines(&done);
    assert_eq!(found.len(), 1 + expected.len(), "{}", done.out);
    for (line, start) in found[1..].iter().zip(expected) {
        assert!(line.starts_with(start), "{line} is not {start}…");
    }
}

#[test]
fn the_grid_of_a_camera_is_that_of_its_picture() {
    let desk = Desk::new();
    let args = ["ray", "ball.csg", "--grid", "3,2", "--camera", "0,-20,0,0,0,0"];
    let more = ["--projection", "o", "--json"];
    let done = desk.run(&[&args[..], &more].concat());
    // Upper left first; one column of three meets the ball, in both rows.
    let chords: Vec<f64> = lines(&done)
        .iter()
        .map(|line| serde_json::from_str(line).expect("an object a line"))
        .map(|ray: serde_json::Value| ray["chord"].as_f64().expect("a number"))
        .collect();
    // Half a pixel is a quarter of the height of the picture at the ball.
    let up = 0.5 * 20.0 * 11.25_f64.to_radians().tan();
    let chord = 2.0 * (9.0 - up * up).sqrt();
    for (i, found) in chords.iter().enumerate() {
        let expected = if i % 3 == 1 { chord } else { 0.0 };
        assert!((found - expected).abs() < 1e-12, "{i}: {found} is not {expected}");
    }
    assert_eq!(chords.len(), 6);
    let done = desk.run(&[&args[..], &["--columns", "oz", "--projection", "o"]].concat());
    let heights: Vec<f64> =
        lines(&done)[1..].iter().map(|z| z.parse().expect("a number")).collect();
    assert!((heights[0] - up).abs() < 1e-12 && (heights[1] + up).abs() < 1e-12);
}

#[test]
fn every_column_has_a_value() {
    let desk = Desk::new();
    desk.put(
        "red.csg",
        "color([1, 0, 0, 1]) {\n cube(size = [1, 2, 4], center = true);\n}",
    );
    let names = "span,kind_in,kind_out,part_in,part_out,place_in,place_out,face_in,face_out,\
                 leaf_in,leaf_out,nx_in,ny_in,nz_in,nx_out,ny_out,nz_out,x_in,y_in,z_in,x_out,\
                 y_out,z_out,length";
    let ray = ["ray", "red.csg", "--origin", "0,0,9", "--dir", "0,0,-2", "--csv"];
    let done = desk.run(&[&ray[..], &["--columns", names]].concat());
    let expected = "0,cuboid,cuboid,#ff0000,#ff0000,2:2,2:2,5,4,0,0,0.0,0.0,1.0,0.0,0.0,-1.0,\
                    0.0,0.0,2.0,0.0,0.0,-2.0,4.0";
    assert_eq!(lines(&done)[1], expected);

    // The usual ones, and those that are bounds.
    let done = desk.run(&ray);
    assert_eq!(
        lines(&done)[0],
        "ray,t_in,t_out,length,x_in,y_in,z_in,x_out,y_out,z_out,leaf_in,leaf_out"
    );
    let done = desk.run(&[&ray[..], &["--columns", "error_in,error_out"]].concat());
    for error in lines(&done)[1].split(',') {
        let error: f64 = error.parse().expect("a number");
        assert!(0.0 < error && error < 1e-13, "{error:e}");
    }
}

#[test]
fn json_lines_have_the_columns_too() {
    let desk = Desk::new();
    let args = ["ray", "tube.csg", "--grid", "5,1", "--along", "z", "--json"];
    let done = desk.run(&[&args[..], &["--columns", "ray,kind_in,t_out"]].concat());
    let expected = [
        r#"{"schema":1,"ray":0,"kind_in":"cylinder","t_out":10.0}"#,
        r#"{"schema":1,"ray":4,"kind_in":"cylinder","t_out":10.0}"#,
    ];
    assert_eq!(lines(&done), expected);
}

#[test]
fn order_is_kept_on_any_number_of_threads() {
    let desk = Desk::new();
    let args = ["ray", "tube.csg", "--grid", "70,70", "--csv"];
    let one = desk.run(&[&args[..], &["-j", "1"]].concat());
    let four = desk.run(&[&args[..], &["-j", "4"]].concat());
    assert!(lines(&one).len() > 1000);
    assert_eq!(one.out, four.out);
}

#[test]
fn rays_before_a_bad_one_are_answered() {
    let desk = Desk::new();
    let input = "-9 0 0 1 0 0\n-9 0 0 0 0 0\n-9 0 0 1 0 0\n";
    let args = ["ray", "ball.csg", "--columns", "ray,length"];
    let done = desk.run_with_input(&args, input);
    assert_eq!((done.code, done.out.as_str()), (2, "ray,length\n0,6.0\n"));
    assert_eq!(done.err, "solidray: error: the direction is zero\n");
}

#[test]
fn wrong_grids_are_usage_errors() {
    let desk = Desk::new();
    desk.put("nothing.csg", "");
    for (args, said) in [
        (&["ball.csg", "--grid", "0,5"][..], "is not a width and a height"),
        (&["ball.csg", "--along", "x"], "--grid"),
        (&["ball.csg", "--grid", "5,5", "--along", "w"], "possible values"),
        (&["ball.csg", "--grid", "5,5", "--along", "x", "--projection", "o"], "cannot"),
        (&["ball.csg", "--grid", "5,5", "--csv", "--json"], "cannot take both"),
        (&["ball.csg", "--grid", "5,5", "--columns", "ray,weight"], "weight"),
        (&["nothing.csg", "--grid", "5,5", "--along", "x"], "the model is empty"),
    ] {
        let done = desk.run(&[&["ray"], args].concat());
        assert_eq!(done.code, 2, "{args:?}");
        assert!(done.err.contains(said), "{args:?}: {}", done.err);
    }
}

#[test]
#[cfg(unix)]
fn a_grid_without_end_stops_with_its_reader() {
    let desk = Desk::new();
    let program = env!("CARGO_BIN_EXE_solidray");
    let grid = "--grid 4000000000,1 --along z --csv";
    let script = format!("{{ {program} ray ball.csg {grid}; echo $? >&2; }} | head -n 1");
    let done = std::process::Command::new("sh")
        .args(["-c", &script])
        .current_dir(desk.path(""))
        .output()
        .expect("a shell");
    assert!(done.stdout.starts_with(b"ray,t_in"));
    assert_eq!(String::from_utf8_lossy(&done.stderr), "0\n");
}

/// Who asks one by one, as people and programs at the other end of two pipes do, is answered.
#[test]
fn questions_are_answered_as_they_come() {
    use std::io::{BufRead, BufReader, Write};
    use std::process::{Command, Stdio};
    use std::sync::mpsc;

    let desk = Desk::new();
    for (command, rest) in [("ray", "-50 0 0 1"), ("contains", "5")] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_solidray"))
            .args([command, "tube.csg"])
            .current_dir(desk.path(""))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut input = child.stdin.take().expect("it is piped");
        let output = BufReader::new(child.stdout.take().expect("it is piped"));
        let (send, receive) = mpsc::channel();
        let reader = std::thread::spawn(move || {
            for line in output.lines() {
                let _ = send.send(line.expect("text"));
            }
        });
        for y in 0..3 {
            // The next line has only begun.
            input.write_all(format!("4 {y} {rest}\n3").as_bytes()).expect("it reads");
            let limit = std::time::Duration::from_secs(60);
            let is_answer = |line: &String| line.contains(&format!("4,{y},"));
            while !is_answer(&receive.recv_timeout(limit).expect("an answer")) {}
            input.write_all(format!(" 0 {rest}\n").as_bytes()).expect("it reads");
        }
        drop(input);
        assert!(child.wait().expect("it ends").success());
        reader.join().expect("it ends");
    }
}
