//! A real browser without a window, and what it makes of a page.

#[expect(dead_code, reason = "it has several names, of which one is enough")]
#[path = "program.rs"]
mod program;

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use image::RgbImage;

const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Longer than a busy machine needs.
const PATIENCE: Duration = Duration::from_secs(120);

/// An installed browser that can be run from a command line.
pub(crate) struct Browser {
    program: &'static str,
}

/// What a browser wrote.
pub(crate) struct Seen {
    pub(crate) out: String,
    /// With what scripts and pages complain about.
    pub(crate) err: String,
}

impl Browser {
    /// The one that is installed; what is done without it is said. Where it must be there, its
    /// absence is a failure.
    #[expect(
        clippy::print_stderr,
        reason = "a check left out is not left out in silence"
    )]
    pub(crate) fn installed(without: &str) -> Option<Self> {
        let runs = |program: &&str| program::runs(program, "--version");
        let found = NAMES.into_iter().find(runs).map(|program| Self { program });
        if found.is_none() {
            let required = std::env::var_os("SOLIDRAY_REQUIRE_BROWSER").is_some();
            assert!(
                !required,
                "a browser is required here, but none of {NAMES:?} is on PATH"
            );
            eprintln!("no browser is installed: {without}");
        }
        found
    }

    /// A page as it is after its scripts have run.
    pub(crate) fn dom(&self, page: &Path) -> Seen {
        self.run(page, &["--dump-dom"])
    }

    /// A page as it is seen through a window of this size.
    pub(crate) fn screenshot(
        &self,
        page: &Path,
        [width, height]: [u32; 2],
    ) -> (RgbImage, Seen) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("shot.png");
        let size = format!("--window-size={width},{height}");
        let shot = format!("--screenshot={}", file.display());
        let seen = self.run(page, &[&size, &shot]);
        let image =
            image::open(&file).unwrap_or_else(|error| panic!("{error}: {}", seen.err));
        (image.into_rgb8(), seen)
    }

    fn run(&self, page: &Path, args: &[&str]) -> Seen {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        let file = |name: &str| File::create(path(name)).expect("a file");
        let mut child = Command::new(self.program)
            .args([
                "--headless=new",
                "--no-sandbox",
                "--disable-gpu",
                "--hide-scrollbars",
            ])
            .args([
                "--disable-dev-shm-usage",
                "--no-first-run",
                "--force-device-scale-factor=1",
            ])
            // No name leads anywhere: what is not in the page is not there.
            .args(["--host-resolver-rules=MAP * ~NOTFOUND", "--enable-logging=stderr"])
            .arg(format!("--user-data-dir={}", path("profile").display()))
            .args(args)
            .arg(format!("file://{}", page.display()))
            .stdin(Stdio::null())
            .stdout(file("out"))
            .stderr(file("err"))
            .spawn()
            .expect("the browser starts");
        let start = Instant::now();
        let read = |name: &str| {
            String::from_utf8_lossy(&fs::read(path(name)).expect("a file")).into_owned()
        };
        while child.try_wait().expect("it is our child").is_none() {
            if start.elapsed() > PATIENCE {
                let _ = child.kill();
                let _ = child.wait();
                panic!("the browser did not end: {}", read("err"));
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        Seen { out: read("out"), err: read("err") }
    }
}
