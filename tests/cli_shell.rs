//! Completions for shells and pages of the manual.
#![cfg(feature = "cli")]

mod desk;

use desk::Desk;

#[test]
fn every_shell_gets_a_script() {
    let desk = Desk::new();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let done = desk.run(&["completions", shell]);
        assert_eq!(done.code, 0, "{shell}: {}", done.err);
        for word in ["overlaps", "imgsize", "openscad-limit"] {
            assert!(done.out.contains(word), "{shell} does not know {word}");
        }
    }
    assert_eq!(desk.run(&["completions", "cmd"]).code, 2);
}

#[test]
fn every_command_has_a_page() {
    let desk = Desk::new();
    let whole = desk.run(&["man"]);
    assert!(whole.out.contains(".TH solidray 1"), "{}", whole.out);
    assert!(whole.out.contains("volume"));
    let page = desk.run(&["man", "render"]);
    assert!(page.out.contains("solidray\\-render"), "{}", page.out);
    assert!(page.out.contains("imgsize"));
    let none = desk.run(&["man", "dance"]);
    assert_eq!(none.code, 2);
    assert_eq!(none.err, "solidray: error: there is no command `dance`\n");
}
