//! What cameras see, as text, and what pictures are made of it.

use glam::{DVec3, dvec3};
use solidray::render::{Camera, Frame, Projection, trace};
use solidray::{Scene, Sense, Solid};

const SIZE: [u32; 2] = [64, 48];

fn compile(solid: &Solid) -> Scene {
    Scene::compile(solid).expect("a sound solid")
}

fn frame(scene: &Scene, camera: &Camera) -> Frame {
    trace(scene, &camera.view(SIZE, &scene.bounds()), [0.5, 0.5], &|_| ())
}

/// A line for each second row, as letters are twice as high as wide: the number of the
/// leaf that is seen, or a dot.
fn art(frame: &Frame) -> String {
    let [width, height] = frame.size();
    let letter = |x, y| match frame.hit(x, y) {
        Some(hit) => char::from_digit(hit.leaf % 36, 36).unwrap_or('?'),
        None => '.',
    };
    let row = |y| (0..width).map(|x| letter(x, y)).collect::<String>();
    (0..height).step_by(2).map(row).collect::<Vec<_>>().join("\n")
}

/// A plate with a round hole and a ball on it.
fn plate() -> Solid {
    let hole = Solid::cylinder(4.0, 8.0).translated(dvec3(-8.0, 0.0, -4.0));
    let ball = Solid::ball(5.0).translated(dvec3(8.0, 0.0, 4.0));
    Solid::cuboid(dvec3(36.0, 20.0, 4.0)) - hole + ball
}

#[test]
fn plate_from_the_default_camera() {
    let scene = compile(&plate());
    let camera = Camera::framing(&scene.bounds());
    insta::assert_snapshot!(art(&frame(&scene, &camera)));
}

#[test]
fn plate_in_parallel_from_above() {
    let scene = compile(&plate());
    let camera = Camera { rotation_deg: DVec3::ZERO, ..Camera::framing(&scene.bounds()) }
        .with_projection(Projection::Orthographic);
    insta::assert_snapshot!(art(&frame(&scene, &camera)));
}

#[test]
fn a_cube_covers_the_pixels_it_should() {
    let scene = compile(&Solid::cuboid(DVec3::splat(10.0)));
    let front = Camera {
        rotation_deg: dvec3(90.0, 0.0, 0.0),
        distance: 10.0 / 11.25_f64.to_radians().tan(),
        ..Camera::default()
    };
    // The picture is 20 units high, 48 pixels: the cube's face is 24 pixels wide.
    let seen = frame(&scene, &front.with_projection(Projection::Orthographic));
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let inside = (20..44).contains(&x) && (12..36).contains(&y);
            assert_eq!(seen.hit(x, y).is_some(), inside, "pixel ({x}, {y})");
        }
    }
}

#[test]
fn orthographic_cameras_see_what_is_behind_them() {
    let scene = compile(&Solid::ball(1.0).translated(dvec3(0.0, -500.0, 0.0)));
    let camera = Camera::gimbal([0.0, 0.0, 0.0, 90.0, 0.0, 0.0, 20.0]).expect("finite");
    assert_eq!(frame(&scene, &camera).depths(), None);
    let parallel = camera.with_projection(Projection::Orthographic);
    let seen = frame(&scene, &parallel);
    let hit = seen.hit(32, 24).expect("the ball is in the middle");
    let place = seen.ray(32, 24).at(hit.t);
    assert!((place.distance(dvec3(0.0, -500.0, 0.0)) - 1.0).abs() < 1e-9);
}

#[test]
fn an_eye_inside_sees_where_rays_come_out() {
    let scene = compile(&Solid::ball(50.0));
    let camera = Camera { distance: 10.0, ..Camera::default() };
    let seen = frame(&scene, &camera);
    assert!((0..SIZE[1]).all(|y| {
        (0..SIZE[0]).all(|x| seen.hit(x, y).is_some_and(|hit| hit.sense == Sense::Exit))
    }));
}

#[test]
fn empty_scenes_and_empty_frames() {
    let scene = compile(&Solid::empty());
    assert_eq!(frame(&scene, &Camera::framing(&scene.bounds())).depths(), None);
    let ball = compile(&Solid::ball(1.0));
    for size in [[0, 0], [0, 7], [7, 0]] {
        let view = Camera::default().view(size, &ball.bounds());
        assert_eq!(trace(&ball, &view, [0.5, 0.5], &|_| ()).hit(0, 0), None);
    }
}

#[cfg(feature = "image")]
mod pictures {
    use std::sync::atomic::{AtomicU64, Ordering};

    use image::RgbImage;
    use solidray::Color;
    use solidray::Mesh;
    use solidray::render::{
        Light, Look, Scheme, Shown, Style, Translucent, picture, picture_bands, shade,
    };

    use super::*;

    /// How many pixels differ by more than `step` of 255 in any channel.
    fn differing(a: &RgbImage, b: &RgbImage, step: u8) -> usize {
        assert_eq!(a.dimensions(), b.dimensions());
        a.pixels()
            .zip(b.pixels())
            .filter(|(a, b)| a.0.iter().zip(b.0).any(|(&a, b)| a.abs_diff(b) > step))
            .count()
    }

    fn painted(solid: &Solid, style: &Style) -> RgbImage {
        let scene = compile(solid);
        let camera = Camera::framing(&scene.bounds());
        picture(&scene, &camera, SIZE, style, &|_| ())
    }

    #[test]
    fn one_sample_is_a_shaded_frame() {
        let scene = compile(&plate());
        let camera = Camera::framing(&scene.bounds());
        let frame = frame(&scene, &camera);
        for look in Look::ALL {
            let style = Style { look, ..Style::default() };
            let shaded = shade(&scene, &frame, look, &style.scheme);
            let image = picture(&scene, &camera, SIZE, &style, &|_| ());
            assert_eq!(differing(&shaded, &image, 0), 0, "{look:?}");
        }
    }

    #[test]
    fn samples_change_edges_only() {
        let style = |samples| Style { samples, ..Style::default() };
        let [few, many, more] = [1, 16, 64].map(|n| painted(&plate(), &style(n)));
        let edges = differing(&few, &many, 12);
        assert!((50..500).contains(&edges), "{edges} pixels of 3072");
        let changes = differing(&many, &more, 12);
        assert!(changes < edges / 4, "{changes} pixels, {edges} at edges");
    }

    #[test]
    fn looks_have_their_grounds_and_colors() {
        let corner = |look| {
            *painted(&plate(), &Style { look, ..Style::default() }).get_pixel(0, 0)
        };
        assert_eq!(corner(Look::Shaded).0, [0xff, 0xff, 0xe5]);
        assert_eq!(corner(Look::Leaf).0, [0xff, 0xff, 0xe5]);
        assert_eq!(corner(Look::Normal).0, [0, 0, 0]);
        assert_eq!(corner(Look::Depth).0, [0, 0, 0]);

        let blue = Solid::ball(1.0).colored(Color::rgb(0.0, 0.0, 1.0));
        let [r, g, b] = painted(&blue, &Style::default()).get_pixel(32, 24).0;
        assert!(b > 150 && r < 80 && g < 80, "{r} {g} {b}");
    }

    #[test]
    fn a_normal_seen_from_above_is_z() {
        let scene = compile(&Solid::cuboid(DVec3::ONE));
        let above =
            Camera { rotation_deg: DVec3::ZERO, ..Camera::framing(&scene.bounds()) };
        let style = Style { look: Look::Normal, ..Style::default() };
        let image = picture(&scene, &above, SIZE, &style, &|_| ());
        assert_eq!(image.get_pixel(32, 24).0, [128, 128, 255]);
    }

    #[test]
    fn the_nearest_is_white() {
        let style = Style { look: Look::Depth, ..Style::default() };
        let image = painted(&plate(), &style);
        assert_eq!(image.pixels().map(|p| p.0[0]).max(), Some(255));
        let grey = |v: u8| v == 0 || v >= 38;
        assert!(image.pixels().all(|p| grey(p.0[0]) && p.0[0] == p.0[2]));
    }

    #[test]
    fn schemes_have_their_ground_and_what_has_no_color_theirs() {
        let style = |name| {
            let scheme = Scheme::named(name).expect(name);
            Style { scheme, ..Style::default() }
        };
        let sky = painted(&plate(), &style("clear sky"));
        assert_eq!(sky.get_pixel(0, 0).0, [0x88, 0xce, 0xeb]);
        assert_eq!(sky.get_pixel(0, SIZE[1] - 1).0, [0xc8, 0xe9, 0xf6]);
        let [r, g, b] = painted(&Solid::ball(1.0), &style("Nature")).get_pixel(32, 24).0;
        assert!(g > r && b > r, "{r} {g} {b}");
    }

    /// The pixels that lines darken.
    fn lines(solid: &Solid) -> Vec<[u32; 2]> {
        let with = painted(solid, &Style { edges: true, ..Style::default() });
        let without = painted(solid, &Style::default());
        let pixels = with.enumerate_pixels().zip(without.pixels());
        pixels.filter(|((_, _, a), b)| a != b).map(|((x, y, _), _)| [x, y]).collect()
    }

    #[test]
    fn lines_are_where_something_ends_or_turns() {
        // A ball has an outline and nothing in it.
        let [ball, fine] = [lines(&Solid::ball(3.0)), lines(&faceted_ball())];
        let is_outline = |[x, y]: &[u32; 2]| {
            let (right, down) = (f64::from(*x) - 31.5, f64::from(*y) - 23.5);
            (12.0..15.0).contains(&right.hypot(down))
        };
        assert!(ball.len() > 60 && ball.iter().all(is_outline), "{ball:?}");
        assert!(fine.iter().all(is_outline), "triangles are not drawn: {fine:?}");
        // A box has three edges in front as well, and what lies flush on it has none.
        let half = |side: f64| {
            Solid::cuboid(dvec3(3.0, 6.0, 6.0)).translated(dvec3(side, 0.0, 0.0))
        };
        let whole = lines(&Solid::cuboid(dvec3(6.0, 6.0, 6.0)));
        assert_eq!(whole, lines(&(half(1.5) + half(-1.5))));
        // Seen from above it has four edges, and a step of a pixel on it another four.
        let above = |solid: &Solid| {
            let scene = compile(solid);
            let camera =
                Camera { rotation_deg: DVec3::ZERO, ..Camera::framing(&scene.bounds()) }
                    .with_projection(Projection::Orthographic);
            let style = |edges| Style { edges, ..Style::default() };
            let [a, b] =
                [false, true].map(|e| picture(&scene, &camera, SIZE, &style(e), &|_| ()));
            differing(&a, &b, 0)
        };
        let flat = above(&Solid::cuboid(dvec3(6.0, 6.0, 6.0)));
        let small = Solid::cuboid(dvec3(3.0, 3.0, 3.0)).translated(dvec3(0.0, 0.0, 3.0));
        let step = above(&(Solid::cuboid(dvec3(6.0, 6.0, 6.0)) + small));
        assert!(step > flat + 20, "{step} and {flat} pixels");
    }

    /// A ball of 40 by 20 facets, whose edges turn by 9°.
    fn faceted_ball() -> Solid {
        let at = |i: usize, j: usize| {
            let (polar, around) = (j as f64 / 20.0, i as f64 / 20.0);
            let [(s, z), (y, x)] =
                [polar, around].map(|a| (std::f64::consts::PI * a).sin_cos());
            3.0 * dvec3(s * x, s * y, z)
        };
        let mut points: Vec<DVec3> =
            (1..20).flat_map(|j| (0..40).map(move |i| at(i, j))).collect();
        points.extend([dvec3(0.0, 0.0, 3.0), dvec3(0.0, 0.0, -3.0)]);
        let mut faces = Vec::new();
        for i in 0..40_u32 {
            let next = (i + 1) % 40;
            for j in 0..18 {
                let [a, b, c, d] = [i, next, i + 40, next + 40].map(|k| k + 40 * j);
                faces.extend([[a, c, d], [a, d, b]]);
            }
            faces.extend([[760, i, next], [761, 720 + next, 720 + i]]);
        }
        Solid::mesh(Mesh::new(points, faces).expect("it is closed"))
    }

    #[test]
    fn soft_light_falls_on_what_is_open() {
        let soft = Style { light: Light::Soft { rays: 12 }, ..Style::default() };
        // Nothing stands in the light of what is convex.
        for convex in
            [Solid::ball(3.0), Solid::cuboid(dvec3(1.0, 2.0, 3.0)), faceted_ball()]
        {
            let [a, b] = [painted(&convex, &soft), painted(&convex, &Style::default())];
            assert_eq!(differing(&a, &b, 0), 0);
        }
        // The floor of a shaft is darker the deeper it is.
        let brightness = |depth: f64| {
            let shaft = Solid::cuboid(dvec3(2.0, 2.0, 2.0 * depth))
                .translated(dvec3(0.0, 0.0, 6.0));
            let scene = compile(&(Solid::cuboid(DVec3::splat(12.0)) - shaft));
            let camera =
                Camera { rotation_deg: DVec3::ZERO, ..Camera::framing(&scene.bounds()) };
            let image = picture(&scene, &camera, SIZE, &soft, &|_| ());
            u32::from(image.get_pixel(32, 24).0[1])
        };
        let [shallow, deep, deeper] = [0.1, 0.5, 8.0].map(brightness);
        assert!(shallow > deep + 5 && deep > deeper + 20, "{shallow} {deep} {deeper}");
    }

    #[test]
    fn what_is_seen_through_covers_in_part() {
        let red = Color::rgb(1.0, 0.0, 0.0);
        let wall = Solid::cuboid(dvec3(20.0, 1.0, 20.0)).translated(dvec3(0.0, 5.0, 0.0));
        let wall = compile(&wall.colored(red));
        let blue = |alpha| Color { rgba: [0.0, 0.0, 1.0, alpha] };
        let ball = |x, alpha| {
            let ball = Solid::ball(3.0).translated(dvec3(x, -2.0, 0.0));
            compile(&ball.colored(blue(alpha)))
        };
        let behind = compile(&Solid::ball(2.0).translated(dvec3(0.0, 9.0, 0.0)));
        let camera = Camera {
            rotation_deg: dvec3(90.0, 0.0, 0.0),
            distance: 40.0,
            ..Camera::default()
        };
        let style = Style { samples: 4, ..Style::default() };
        let image = |solid: &Scene, layers: &[(&Scene, f32)]| {
            let layer = |&(scene, alpha)| Translucent { scene, color: blue(alpha) };
            let translucent: Vec<_> = layers.iter().map(layer).collect();
            let shown = Shown { solid, translucent: &translucent };
            picture(shown, &camera, SIZE, &style, &|_| ())
        };
        let before = ball(0.0, 1.0);
        let whole = compile(&Solid::boolean(
            solidray::Op::Union,
            [
                Solid::cuboid(dvec3(20.0, 1.0, 20.0))
                    .translated(dvec3(0.0, 5.0, 0.0))
                    .colored(red),
                Solid::ball(3.0).translated(dvec3(0.0, -2.0, 0.0)).colored(blue(1.0)),
            ],
        ));
        let [none, half, all] = [0.0, 0.5, 1.0].map(|a| image(&wall, &[(&before, a)]));
        assert_eq!(differing(&none, &image(&wall, &[]), 0), 0);
        assert_eq!(differing(&all, &image(&whole, &[]), 1), 0);
        assert_eq!(differing(&none, &image(&wall, &[(&behind, 1.0)]), 0), 0);
        for channel in 0..3 {
            let at = |image: &RgbImage| f64::from(image.get_pixel(32, 24).0[channel]);
            let mean = 0.5 * (at(&none) + at(&all));
            assert!((at(&half) - mean).abs() <= 1.0, "{channel}: {} {mean}", at(&half));
        }

        // It does not matter which is named first, and no look without light shows them.
        let (a, b) = (ball(-1.0, 1.0), ball(1.0, 1.0));
        let [ab, ba] = [[(&a, 0.3), (&b, 0.6)], [(&b, 0.6), (&a, 0.3)]];
        assert_eq!(differing(&image(&wall, &ab), &image(&wall, &ba), 0), 0);
        let translucent = [Translucent { scene: &before, color: blue(0.5) }];
        for look in [Look::Normal, Look::Depth] {
            let style = Style { look, ..style };
            let shown = Shown { solid: &wall, translucent: &translucent };
            let [with, without] = [shown, Shown::from(&wall)]
                .map(|shown| picture(shown, &camera, SIZE, &style, &|_| ()));
            assert_eq!(differing(&with, &without, 0), 0, "{look:?}");
        }
    }

    #[test]
    fn bands_are_the_picture() {
        let (scene, ball) = (compile(&plate()), compile(&Solid::ball(30.0)));
        let color = Color { rgba: [0.0, 1.0, 0.0, 0.5] };
        let shown =
            Shown { solid: &scene, translucent: &[Translucent { scene: &ball, color }] };
        let camera = Camera::framing(&shown.bounds());
        let style = Style { edges: true, ..Style::default() };
        let size = [4096, 700];
        let whole = picture(shown, &camera, size, &style, &|_| ());
        let bands: Vec<RgbImage> =
            picture_bands(shown, &camera, size, &style, &|_| ()).collect();
        assert!(bands.len() > 2);
        let bytes: Vec<u8> = bands.into_iter().flat_map(RgbImage::into_raw).collect();
        assert!(whole.into_raw() == bytes);
    }

    /// Pictures are traced in bands; at this width they are 64 rows high. Lines belong to the pixels
    /// beside what ends, so those of two boxes that end where a band does are on its border rows.
    #[test]
    fn lines_go_on_across_bands() {
        let size = [1 << 15, 130];
        // One unit a pixel, z = 0 between rows 64 and 65.
        let camera = Camera {
            rotation_deg: dvec3(90.0, 0.0, 0.0),
            distance: 65.0 / 11.25_f64.to_radians().tan(),
            ..Camera::default()
        }
        .with_projection(Projection::Orthographic);
        let slab = |low: f64, x: f64| {
            let middle = dvec3(x, 0.0, low + 5.0);
            Solid::cuboid(dvec3(40.0, 10.0, 10.0)).translated(middle)
        };
        // The first ends above the border of bands, the second below it.
        let scene = compile(&(slab(1.0, -50.0) + slab(-9.0, 50.0)));
        let image = |edges| {
            let style = Style { edges, ..Style::default() };
            picture(&scene, &camera, size, &style, &|_| ())
        };
        let [plain, lined] = [false, true].map(image);
        for (y, x, row_is_line) in
            [(63, -50, true), (62, -50, false), (64, 50, true), (65, 50, false)]
        {
            for x in x - 15..x + 15 {
                let x = (x + (1_i32 << 14)).cast_unsigned();
                let is_line = plain.get_pixel(x, y) != lined.get_pixel(x, y);
                assert_ne!(plain.get_pixel(x, y).0, [0xff, 0xff, 0xe5], "({x}, {y})");
                assert_eq!(is_line, row_is_line, "({x}, {y})");
            }
        }
    }

    #[test]
    fn all_rays_are_reported() {
        let scene = compile(&plate());
        for (look, edges) in [(Look::Shaded, false), (Look::Depth, true)] {
            let style = Style { look, edges, samples: 3, ..Style::default() };
            let rays = AtomicU64::new(0);
            let count = |n| {
                rays.fetch_add(n, Ordering::Relaxed);
            };
            picture(&scene, &Camera::default(), SIZE, &style, &count);
            assert_eq!(rays.into_inner(), style.rays(SIZE, 0));
        }
    }

    #[cfg(feature = "parallel")]
    #[test]
    fn threads_change_nothing() {
        let light = Light::Soft { rays: 5 };
        let style = Style { samples: 4, light, edges: true, ..Style::default() };
        let on = |threads| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .expect("threads can be made")
                .install(|| painted(&plate(), &style))
        };
        assert_eq!(on(1), on(5));
    }
}
