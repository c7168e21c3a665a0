//! How errors look on a terminal.
#![cfg(feature = "cli")]

mod desk;

use desk::Desk;

#[test]
fn errors_show_the_line() {
    let desk = Desk::new();
    desk.put("part.csg", "group() {\n\tcube(size = [1, 2, 3,, 4]);\n}\n");
    let done = desk.run(&["volume", "part.csg"]);
    let expected = "solidray: error: part.csg:2:23: expected a value, found `,`\n   \
                    cube(size = [1, 2, 3,, 4]);\n                        ^\n";
    assert_eq!((done.code, done.out.as_str(), done.err.as_str()), (2, "", expected));
    desk.put("whole.csg", "import(file = \"part.obj\");");
    desk.put("part.obj", "v 0 0 0\nf 1 2 3\n");
    let done = desk.run(&["volume", "whole.csg"]);
    assert!(done.err.ends_with("\n  f 1 2 3\n  ^\n"), "{}", done.err);
    // No more of a model from standard input than its place.
    let done = desk.run_with_input(&["volume", "-", "--format", "csg"], "cube(");
    assert_eq!(done.err.lines().count(), 1, "{}", done.err);
}
