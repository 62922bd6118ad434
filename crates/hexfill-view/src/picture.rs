//! A still picture of a mesh: the surface, and the mesh cut open with its hexes drawn slightly shrunk.
//!
//! Parallel projection along a fixed direction, z up; see [`crate::raster`] for why the bytes are reproducible.
//!
//! Source: ours.

use crate::ViewInput;
use crate::colour::{INSIDE, Rgb, SURFACE, Scale, category};
use crate::raster::{Canvas, Corner};
use hexfill_mesh::Facet;

/// Samples along each side of a pixel.
const SAMPLES: usize = 3;
/// From the mesh towards the eye; the viewer starts there too.
const TOWARDS_EYE: [f64; 3] = [1.0, -1.9, 1.05];
/// From the mesh towards the light, in screen axes (right, up, towards the eye).
const TOWARDS_LIGHT: [f64; 3] = [-0.35, 0.65, 0.67];

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Panels {
    /// The boundary.
    Surface,
    /// The half of the hexes away from the eye, shrunk.
    CutAway,
    /// Both, side by side.
    Both,
}

/// How a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels; taken into 16 ..= 8192.
    pub width: u32,
    /// Height in pixels; taken into 16 ..= 8192.
    pub height: u32,
    /// What is shown.
    pub panels: Panels,
    /// Size of the hexes of the cut-away, 0 to 1: 1 is the true size. More than 20 000 hexes always have their true
    /// size, because the gaps would be smaller than a pixel.
    pub shrink: f64,
    /// Light lines on a dark ground.
    pub dark: bool,
}

impl Picture {
    /// A light picture with both panels if it is wide, else with the cut-away.
    pub fn new(width: u32, height: u32) -> Self {
        let panels = if 2 * u64::from(width) >= 3 * u64::from(height) { Panels::Both } else { Panels::CutAway };
        Self { width, height, panels, shrink: 0.86, dark: false }
    }

    /// Width and height within their limits.
    pub(crate) fn size(&self) -> (u32, u32) {
        (self.width.clamp(16, 8192), self.height.clamp(16, 8192))
    }
}

/// Draws `input` as a PNG file (8-bit RGB) of `width` by `height` pixels: [`png_with`] and [`Picture::new`].
pub fn png(input: &ViewInput<'_>, width: u32, height: u32) -> Vec<u8> {
    png_with(input, &Picture::new(width, height))
}

/// Draws `input` as a PNG file (8-bit RGB). Hexes without finite positions are left out; never fails.
pub fn png_with(input: &ViewInput<'_>, picture: &Picture) -> Vec<u8> {
    let (width, height) = picture.size();
    encoded(width, height, &draw_rows(input, picture))
}

/// Rows of pixels, three bytes each, as a PNG file.
pub(crate) fn encoded(width: u32, height: u32, rows: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let written = encoder.write_header().and_then(|mut w| {
        w.write_image_data(rows)?;
        w.finish()
    });
    written.expect("rows have the size of the header, and memory takes them");
    file
}

/// The pixels of a picture, row by row.
pub(crate) fn draw_rows(input: &ViewInput<'_>, picture: &Picture) -> Vec<u8> {
    let (width, height) = picture.size();
    let (width, height) = (width as usize, height as usize);
    let (top, bottom): (Rgb, Rgb) =
        if picture.dark { ([0x23, 0x28, 0x30], [0x14, 0x17, 0x1c]) } else { ([0xff; 3], [0xee, 0xf1, 0xf4]) };
    let (w, h) = (width * SAMPLES, height * SAMPLES);
    let mut canvas = Canvas::new(w, h, |y| crate::colour::sample(&[top, bottom], y as f64 / h as f64));
    let scene = Scene::new(input, picture);
    let panels: &[(bool, f64)] = match picture.panels {
        Panels::Surface => &[(false, 0.5)],
        Panels::CutAway => &[(true, 0.5)],
        Panels::Both => &[(false, 0.25), (true, 0.75)],
    };
    let view = View::fit(&scene, w as f64 / panels.len() as f64, h as f64);
    for &(cut, centre) in panels {
        scene.draw(&mut canvas, &View { centre: [centre * w as f64, 0.5 * h as f64], ..view }, cut);
    }
    canvas.reduced(SAMPLES)
}

/// The map from space to samples.
#[derive(Clone, Copy)]
struct View {
    axes: [[f64; 3]; 3],
    middle: [f64; 2],
    scale: f64,
    centre: [f64; 2],
}

impl View {
    /// Fits everything drawn into `width` by `height` samples with a margin.
    fn fit(scene: &Scene<'_>, width: f64, height: f64) -> Self {
        let eye = unit(TOWARDS_EYE);
        let right = unit([-eye[1], eye[0], 0.0]);
        let up = cross(eye, right);
        let axes = [right, up, eye];
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let corners = scene.drawn.iter().flat_map(|&h| scene.input.mesh.hexes()[h as usize]);
        for v in corners {
            for c in 0..2 {
                let x = dot(axes[c], scene.input.points[v.index()]);
                low[c] = low[c].min(x);
                high[c] = high[c].max(x);
            }
        }
        if low[0] > high[0] {
            (low, high) = ([0.0; 2], [0.0; 2]);
        }
        let extent = [high[0] - low[0], high[1] - low[1]].map(|e| if e > 0.0 { e } else { 1e-30 });
        let scale = (0.9 * width / extent[0]).min(0.9 * height / extent[1]);
        Self { axes, middle: [0, 1].map(|c| 0.5 * (low[c] + high[c])), scale, centre: [0.0; 2] }
    }

    fn corner(&self, p: [f64; 3], light: f64) -> Corner {
        Corner {
            x: self.centre[0] + self.scale * (dot(self.axes[0], p) - self.middle[0]),
            y: self.centre[1] - self.scale * (dot(self.axes[1], p) - self.middle[1]),
            depth: -self.scale * dot(self.axes[2], p),
            light,
        }
    }

    /// Brightness of a patch with normal `n`; a patch seen from behind is lit as from the front.
    fn light(&self, n: [f64; 3]) -> f64 {
        let length = dot(n, n).sqrt();
        if length == 0.0 {
            return 0.8;
        }
        let mut seen = self.axes.map(|axis| dot(axis, n) / length);
        if seen[2] < 0.0 {
            seen = seen.map(|c| -c);
        }
        0.66 + 0.38 * dot(seen, unit(TOWARDS_LIGHT)).max(0.0)
    }
}

struct Scene<'a> {
    input: &'a ViewInput<'a>,
    /// Hexes with positions, ascending.
    drawn: Vec<u32>,
    /// Per hex: whether the cut-away shows it.
    kept: Vec<bool>,
    shrink: f64,
    edge: f64,
    edge_colour: Rgb,
    ghost_colour: Rgb,
    scale: Option<(Scale, &'a [f64])>,
}

impl<'a> Scene<'a> {
    fn new(input: &'a ViewInput<'a>, picture: &Picture) -> Self {
        let mesh = input.mesh;
        let drawn: Vec<u32> = (0..mesh.n_hexes() as u32)
            .filter(|&h| mesh.hexes()[h as usize].iter().all(|v| input.has_position(v.index())))
            .collect();
        // Cut across y, the axis that points at the eye most: half of the hexes, by the y of their centres, stay.
        let depth = |h: u32| mesh.hexes()[h as usize].iter().map(|v| input.points[v.index()][1]).sum::<f64>();
        let mut order = drawn.clone();
        order.sort_by(|&a, &b| depth(b).total_cmp(&depth(a)).then(a.cmp(&b)));
        let mut kept = vec![false; mesh.n_hexes()];
        // Hexes level with the last one to stay are not torn apart.
        if let Some(&middle) = order.get(order.len().saturating_sub(1) / 2) {
            let (front, back) = (depth(order[order.len() - 1]), depth(order[0]));
            let limit = depth(middle) - 1e-9 * (back - front);
            for &h in &order {
                kept[h as usize] = depth(h) >= limit;
            }
        }
        let (edge_colour, ghost_colour) = if picture.dark {
            ([0x10, 0x13, 0x18], [0x4a, 0x54, 0x60])
        } else {
            ([0x3a, 0x46, 0x52], [0xc4, 0xcb, 0xd2])
        };
        let shrink =
            if picture.shrink.is_finite() && drawn.len() <= 20_000 { picture.shrink.clamp(0.05, 1.0) } else { 1.0 };
        let values = input.values();
        // Thinner lines where quads are small.
        let edge = if drawn.len() > 20_000 {
            0.35
        } else if drawn.len() > 2_000 {
            0.6
        } else {
            1.1
        } * SAMPLES as f64
            * 0.6;
        Self {
            input,
            drawn,
            kept,
            shrink,
            edge,
            edge_colour,
            ghost_colour,
            scale: values.map(|(name, values)| (Scale::new(name, values), values)),
        }
    }

    fn draw(&self, canvas: &mut Canvas, view: &View, cut: bool) {
        let mesh = self.input.mesh;
        if cut {
            for &h in self.drawn.iter().filter(|&&h| !self.kept[h as usize]) {
                self.ghost(canvas, view, h);
            }
        }
        for &h in self.drawn.iter().filter(|&&h| !cut || self.kept[h as usize]) {
            let centre = self.centre(h);
            let groups = self.input.groups.filter(|groups| groups.first);
            let scale = self.scale.filter(|_| groups.is_none());
            let plain = scale.map(|(scale, values)| scale.colour(values[h as usize]));
            for side in 0..6 {
                let facet = Facet::new(hexfill_mesh::HexId(h), side);
                let beyond = mesh.neighbour(facet);
                let hidden = beyond.is_some_and(|g| {
                    let h = g.hex().index();
                    if cut { self.kept[h] && self.shrink == 1.0 } else { mesh_has_positions(self.input, h) }
                });
                if hidden {
                    continue;
                }
                let group = groups.and_then(|groups| groups.of(6 * h + side as u32));
                let plain = group.map(|group| category(group as usize)).or(plain);
                let colour = plain.unwrap_or(if beyond.is_none() { SURFACE } else { INSIDE });
                let p = mesh.facet_vertices(facet).map(|v| {
                    let p = self.input.points[v.index()];
                    let s = if cut { self.shrink } else { 1.0 };
                    [0, 1, 2].map(|c| centre[c] + s * (p[c] - centre[c]))
                });
                let corners = [0, 1, 2, 3].map(|i| {
                    let normal = cross(minus(p[(i + 1) % 4], p[i]), minus(p[(i + 3) % 4], p[i]));
                    view.corner(p[i], view.light(normal))
                });
                canvas.quad(corners, colour, self.edge, self.edge_colour);
            }
        }
    }

    /// The boundary sides of a hex that was cut away, as thin lines behind everything.
    fn ghost(&self, canvas: &mut Canvas, view: &View, h: u32) {
        for side in 0..6 {
            let facet = Facet::new(hexfill_mesh::HexId(h), side);
            if self.input.mesh.neighbour(facet).is_some() {
                continue;
            }
            let p = self.input.mesh.facet_vertices(facet).map(|v| view.corner(self.input.points[v.index()], 1.0));
            for i in 0..4 {
                canvas.backdrop_line(p[i], p[(i + 1) % 4], 0.4 * SAMPLES as f64, self.ghost_colour);
            }
        }
    }

    fn centre(&self, h: u32) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for v in self.input.mesh.hexes()[h as usize] {
            for (s, c) in sum.iter_mut().zip(self.input.points[v.index()]) {
                *s += 0.125 * c;
            }
        }
        sum
    }
}

fn mesh_has_positions(input: &ViewInput<'_>, h: usize) -> bool {
    input.mesh.hexes()[h].iter().all(|v| input.has_position(v.index()))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|c| c / length)
}
