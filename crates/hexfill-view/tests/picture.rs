//! Pictures: their size, what is seen on them, and that their bytes never change.

mod common;

use common::{ball, grid, refinement, scaled_jacobian};
use hexfill_mesh::HexMesh;
use hexfill_view::{Panels, Picture, ViewInput, png, png_with};

fn input(shape: &common::Shape) -> ViewInput<'_> {
    ViewInput {
        title: "",
        points: &shape.points,
        mesh: &shape.mesh,
        hex_values: None,
        shelling: None,
        groups: None,
        facts: &[],
    }
}

/// Width, height and pixels of a PNG file.
fn decode(file: &[u8]) -> (u32, u32, Vec<[u8; 3]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().expect("a PNG file");
    let mut rows = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut rows).expect("a picture");
    (info.width, info.height, rows.as_chunks::<3>().0.to_vec())
}

/// Pixels with more red than blue: facets inside, in the plain colours.
fn warm(pixels: &[[u8; 3]]) -> usize {
    pixels.iter().filter(|p| p[0] > p[2].saturating_add(20)).count()
}

#[test]
fn the_surface_hides_the_inside_and_the_cut_shows_it() {
    let shape = grid(4, 4, 4);
    let picture = Picture { panels: Panels::Surface, ..Picture::new(200, 160) };
    let (width, height, pixels) = decode(&png_with(&input(&shape), &picture));
    assert_eq!((width, height, pixels.len()), (200, 160, 32_000));
    assert_eq!(warm(&pixels), 0);
    // The cube covers a good part of the picture and touches no side of it.
    let ground = |i: usize| pixels[i].iter().all(|&c| c >= 0xec);
    let covered = (0..pixels.len()).filter(|&i| !ground(i)).count();
    assert!((10_000..25_000).contains(&covered), "{covered}");
    assert!((0..200).all(|x| ground(x) && ground(200 * 159 + x)) && (0..160).all(|y| ground(200 * y)));
    let (.., cut) = decode(&png_with(&input(&shape), &Picture { panels: Panels::CutAway, ..picture }));
    assert!(warm(&cut) > 3000, "{}", warm(&cut));
    let (.., both) = decode(&png(&input(&shape), 400, 160));
    let right: Vec<[u8; 3]> = (0..160).flat_map(|y| both[400 * y + 200..400 * y + 400].to_vec()).collect();
    assert_eq!(warm(&both), warm(&right), "the inside is seen on the right only");
    assert!(warm(&right) > 3000);
}

#[test]
fn values_give_colours() {
    let shape = grid(2, 1, 1);
    let red = [0xa5, 0x00, 0x26];
    let draw = |values: &[f64]| {
        let input = ViewInput { hex_values: Some(("Jacobian", values)), ..input(&shape) };
        let (.., pixels) = decode(&png_with(&input, &Picture { panels: Panels::Surface, ..Picture::new(90, 60) }));
        let near = |c: [u8; 3]| pixels.iter().filter(|p| (0..3).all(|i| p[i].abs_diff(c[i]) < 60)).count();
        (near(red), near([0xd0, 0x00, 0xc8]))
    };
    let (bad, flagged) = draw(&[1e-9, -0.5]);
    assert!(bad > 300 && flagged > 300, "{bad} {flagged}");
    assert_eq!(draw(&[1.0, 1.0]), (0, 0));
}

#[test]
fn the_bytes_never_change() {
    // FNV-1a of the pixels: only basic arithmetic and square roots are used, so every machine must agree.
    let fnv = |shape: &common::Shape, dark: bool| {
        let quality = scaled_jacobian(shape);
        let input = ViewInput { hex_values: Some(("Scaled Jacobian", &quality)), ..input(shape) };
        let file = png_with(&input, &Picture { dark, ..Picture::new(320, 200) });
        assert_eq!(file, png_with(&input, &Picture { dark, ..Picture::new(320, 200) }));
        let (.., pixels) = decode(&file);
        pixels
            .as_flattened()
            .iter()
            .fold(0xcbf2_9ce4_8422_2325u64, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x100_0000_01b3))
    };
    assert_eq!(
        [fnv(&ball(3, 2), false), fnv(&refinement(), true)].map(|h| format!("{h:016x}")),
        ["79df2f1a9ba808a6", "4102792e54039716"]
    );
}

#[test]
fn nothing_breaks_it() {
    let mut shape = grid(2, 2, 2);
    shape.points[13] = [f64::INFINITY, 0.0, 0.0];
    let (.., none) = decode(&png(&input(&shape), 60, 40));
    assert!(none.iter().all(|p| p.iter().all(|&c| c >= 0xec)), "every hex has the bad corner");
    shape.points.truncate(5);
    png(&input(&shape), 60, 40);
    let empty = common::Shape { mesh: HexMesh::try_new(0, &[]).unwrap(), points: vec![] };
    assert_eq!(decode(&png(&input(&empty), 0, 0)).0, 16);
    // All points in one place, or on a line.
    for stretch in [0.0, 1.0] {
        let mut flat = grid(3, 1, 1);
        flat.points.iter_mut().for_each(|p| *p = [stretch * p[0], 0.0, 0.0]);
        let picture = Picture { shrink: f64::NAN, ..Picture::new(64, 64) };
        decode(&png_with(&input(&flat), &picture));
    }
    let mut huge = grid(1, 1, 1);
    huge.points.iter_mut().for_each(|p| *p = p.map(|c| 1e29 * c));
    let (.., pixels) = decode(&png(&input(&huge), 64, 64));
    assert!(pixels.iter().filter(|p| p[0] < 0xe0).count() > 500, "scale does not matter");
}
