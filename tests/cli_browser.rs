//! The page of `compare --report` in a real browser.
#![cfg(feature = "cli")]

#[path = "support/browser.rs"]
mod browser;
mod desk;
#[path = "support/page.rs"]
mod page;

use browser::{Browser, Seen};
use desk::{Desk, TUBE};
use page::Page;
use quick_xml::escape::{escape, unescape};

/// What a browser made of a page in a frame of some width.
#[derive(serde::Deserialize)]
struct Laid {
    width: f64,
    /// How wide its contents are.
    contents: f64,
    title: String,
    headings: usize,
    scripts: usize,
    images: Vec<Image>,
    commands: Vec<String>,
}

#[derive(serde::Deserialize)]
struct Image {
    complete: bool,
    natural: [u32; 2],
    /// Left, top, width, height in the page.
    place: [f64; 4],
}

/// The page in frames of these widths, unchanged, in a page that measures it.
fn laid(browser: &Browser, desk: &Desk, page: &Page, widths: [u32; 3]) -> Vec<Laid> {
    let frames = widths.map(|width| {
        let document = escape(&page.html);
        format!("<iframe width='{width}' height='900' style='border:0' srcdoc=\"{document}\"></iframe>\n")
    });
    let script = "
        const measured = [...document.querySelectorAll('iframe')].map(frame => {
            const page = frame.contentDocument, all = s => [...page.querySelectorAll(s)];
            return {
                width: frame.clientWidth,
                contents: page.documentElement.scrollWidth,
                title: page.title,
                headings: all('h1').length,
                scripts: all('script').length,
                images: all('img').map(image => {
                    const r = image.getBoundingClientRect();
                    return {
                        complete: image.complete,
                        natural: [image.naturalWidth, image.naturalHeight],
                        place: [r.left, r.top, r.width, r.height],
                    };
                }),
                commands: all('pre code').map(code => code.textContent),
            };
        });
        // Letters that the page's text would have other names for.
        const plain = JSON.stringify(measured).replace(/[^ -~]/g,
            c => '\\\\u' + c.charCodeAt(0).toString(16).padStart(4, '0'));
        document.body.textContent = 'measured:' + plain + ':end';";
    desk.put(
        "frames.html",
        &format!(
            "<!DOCTYPE html><meta charset='utf-8'><body>{}<script>onload = () => {{{script}}}</script>",
            frames.concat()
        ),
    );
    let seen = browser.dom(&desk.path("frames.html"));
    assert_calm(&seen);
    let (_, rest) =
        seen.out.rsplit_once("measured:").unwrap_or_else(|| panic!("{}", seen.err));
    let (text, _) = rest.split_once(":end").expect("all of it");
    serde_json::from_str(&unescape(text).expect("text")).expect("what was measured")
}

/// The browser had nothing to say of scripts, policies and what could not be loaded.
fn assert_calm(seen: &Seen) {
    let complaints: Vec<&str> =
        seen.err.lines().filter(|line| line.contains("CONSOLE")).collect();
    assert!(complaints.is_empty(), "{complaints:#?}");
}

#[test]
fn a_browser_shows_the_page() {
    let Some(browser) = Browser::installed("no page is looked at with it") else {
        return;
    };
    let desk = Desk::new();
    let hostile = "<b onclick='x'>&\"<img src=x>.csg";
    desk.put(hostile, TUBE);
    desk.put("other.csg", &TUBE.replace("r1 = 3, r2 = 3", "r1 = 3, r2 = 3.5"));
    let done = desk.run(&["compare", hostile, "other.csg", "--report", "out.html"]);
    assert_eq!(done.code, 1, "{}{}", done.out, done.err);
    let page = Page::read(&desk, "out.html");

    let all = laid(&browser, &desk, &page, [400, 800, 1200]);
    assert_eq!(all.len(), 3);
    for one in &all {
        assert!(one.contents <= one.width, "{} wide in {}", one.contents, one.width);
        assert_eq!(one.title, page.all("title")[0]);
        assert_eq!((one.headings, one.scripts, one.images.len()), (1, 0, 3));
        for image in &one.images {
            assert!(image.complete && image.natural == [640, 480]);
            let [left, _, width, height] = image.place;
            assert!(left >= 0.0 && left + width <= one.width, "within the page");
            assert!(width > 250.0 && (width / height - 4.0 / 3.0).abs() < 0.02);
        }
        assert_eq!(one.commands, page.commands(), "a shell gets what the browser shows");
    }
    let rows = |one: &Laid| {
        let mut tops: Vec<f64> = one.images.iter().map(|image| image.place[1]).collect();
        tops.dedup();
        tops.len()
    };
    assert_eq!(
        [rows(&all[0]), rows(&all[2])],
        [3, 1],
        "below each other, or side by side"
    );

    // What is on the screen are the pictures of the page.
    let (shot, seen) = browser.screenshot(&desk.path("out.html"), [1200, 900]);
    assert_calm(&seen);
    for (picture, image) in page.pictures().iter().zip(&all[2].images) {
        #[expect(clippy::cast_possible_truncation, reason = "pixels of a window")]
        #[expect(clippy::cast_sign_loss, reason = "pixels of a window")]
        let [left, top, width, height] = image.place.map(|x| x.round() as u32);
        let smaller = image::imageops::thumbnail(picture, width, height);
        let mut off = 0;
        for (x, y, pixel) in smaller.enumerate_pixels() {
            let shown = shot.get_pixel(left + x, top + y);
            let apart =
                (0..3).map(|i| pixel.0[i].abs_diff(shown.0[i])).max().expect("three");
            off += usize::from(apart > 48);
        }
        // Edges, which are scaled in another way, and the ring.
        let most = (width * height) as usize / 20;
        assert!(off < most, "{off} of {} pixels are others", width * height);
        let ground = smaller.get_pixel(5, 5).0;
        let drawn = smaller.pixels().filter(|p| p.0 != ground).count();
        assert!(drawn > 4 * most, "there is something in the picture");
    }
}
