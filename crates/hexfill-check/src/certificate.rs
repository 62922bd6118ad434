//! A certificate: what the judge found about one mesh, bound to its content by a hash, checked again by recomputing.
//!
//! The hash covers the stored numbers: positions as bits, hexes and surface quads as indices, in the order given. So the
//! certificate is for the numbers whatever the file format, and for no others.
//!
//! Source: ours.

use crate::input::{Judged, Options};
use crate::judge::judge;
use crate::report::{Ball, Report};
use crate::rule::Level;
use hexfill_mesh::Context;
use serde::{Deserialize, Serialize};

const FORMAT: &str = "hexfill-certificate-1";

/// A statement about one mesh, as JSON. [`certify`] makes it, [`verify_certificate`] recomputes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    /// Name and version of the format.
    pub format: String,
    /// Version of the judge that made it.
    pub judge: String,
    /// blake3 hash of positions and hexes.
    pub mesh: String,
    /// blake3 hash of the surface and its positions, if the mesh was judged against one.
    pub surface: Option<String>,
    /// Vertex ids.
    pub vertices: u64,
    /// Hexes.
    pub hexes: u64,
    /// Boundary quads.
    pub boundary_quads: u64,
    /// "yes", "homology", "no" or "unknown".
    pub ball: String,
    /// The highest level passed: always "L5".
    pub level: String,
    /// Hexes with det J > 0 proved on all of them: all.
    pub det_j_positive: u64,
    /// Certified interval of the least scaled Jacobian over all points of all hexes.
    pub scaled_jacobian: [f64; 2],
    /// Least scaled Jacobian at corners.
    pub corner_scaled_jacobian: f64,
    /// blake3 hash of this certificate with this field empty.
    pub seal: String,
}

/// Why a certificate could not be made or does not hold.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CertificateError {
    /// Not JSON, cut short, or not these fields.
    #[error("the certificate cannot be read (line {line}, column {column}): {reason}")]
    Unreadable {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong there.
        reason: String,
    },
    /// Another format or version of it.
    #[error("the certificate has format {given:?}, this judge reads {FORMAT:?}")]
    Format {
        /// The format named in the certificate.
        given: String,
    },
    /// The seal does not fit the rest.
    #[error("the certificate was altered: its seal does not fit its content")]
    Altered,
    /// The hash of the mesh is another one.
    #[error("the certificate is for another mesh: it names {expected}, positions and hexes given have {found}")]
    OtherMesh {
        /// The hash in the certificate.
        expected: String,
        /// The hash of what was given.
        found: String,
    },
    /// The hash of the surface is another one, or only one of the two has a surface.
    #[error("the certificate is for another surface: it names {expected}, the surface given has {found}")]
    OtherSurface {
        /// The hash in the certificate, or "none".
        expected: String,
        /// The hash of what was given, or "none".
        found: String,
    },
    /// The mesh does not pass every level.
    #[error("the mesh is not certified: it passes {passed}; broken or unproved: {rules}")]
    NotValid {
        /// The highest level passed.
        passed: String,
        /// The broken rules, or the reason why a level was not judged.
        rules: String,
    },
    /// Recomputing gave other numbers.
    #[error("the certificate does not hold: recomputing gives {found} for {field}, it says {expected}")]
    NotReproduced {
        /// The field.
        field: &'static str,
        /// What the certificate says.
        expected: String,
        /// What was computed.
        found: String,
    },
}

fn hash_mesh(input: &Judged<'_>) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(b"hexfill mesh 1\0");
    hasher.update(&(input.n_vertices as u64).to_le_bytes());
    hash_points(&mut hasher, input.points);
    hash_cells(&mut hasher, input.hexes);
    hasher.finalize().to_hex().to_string()
}

fn hash_surface(input: &Judged<'_>) -> Option<String> {
    let surface = input.surface?;
    let mut hasher = blake3::Hasher::new();
    hasher.update(b"hexfill surface 1\0");
    hash_points(&mut hasher, input.surface_points);
    hash_cells(&mut hasher, surface);
    Some(hasher.finalize().to_hex().to_string())
}

fn hash_points(hasher: &mut blake3::Hasher, points: Option<&[[f64; 3]]>) {
    let points = points.unwrap_or_default();
    hasher.update(&(points.len() as u64).to_le_bytes());
    let mut buffer = Vec::with_capacity(24 << 10);
    for block in points.chunks(1 << 10) {
        buffer.clear();
        block.iter().flatten().for_each(|x| buffer.extend_from_slice(&x.to_bits().to_le_bytes()));
        hasher.update(&buffer);
    }
}

fn hash_cells<const K: usize>(hasher: &mut blake3::Hasher, cells: &[[u32; K]]) {
    hasher.update(&(cells.len() as u64).to_le_bytes());
    let mut buffer = Vec::with_capacity((4 * K) << 10);
    for block in cells.chunks(1 << 10) {
        buffer.clear();
        block.iter().flatten().for_each(|v| buffer.extend_from_slice(&v.to_le_bytes()));
        hasher.update(&buffer);
    }
}

impl Certificate {
    fn sealed(mut self) -> Self {
        self.seal = self.expected_seal();
        self
    }

    fn expected_seal(&self) -> String {
        let bare = Self { seal: String::new(), ..self.clone() };
        blake3::hash(bare.to_json().as_bytes()).to_hex().to_string()
    }

    /// The certificate as JSON text.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

fn not_valid(report: &Report) -> CertificateError {
    let passed = report.highest_passed().map_or("no level".to_string(), |l| format!("up to {l}"));
    let mut rules = report.broken_rules().join(", ");
    if rules.is_empty() {
        let why = report.levels.iter().find_map(|l| match &l.outcome {
            crate::Outcome::NotJudged(why) => Some(format!("{} not judged: {why}", l.level)),
            _ => None,
        });
        rules = why.unwrap_or_else(|| "quality was not computed to the end".into());
    }
    CertificateError::NotValid { passed, rules }
}

/// Judges the mesh on every level and, if it passes them all, certifies it.
///
/// # Errors
/// [`CertificateError::NotValid`] if it does not.
///
/// # Example
/// A corner is moved by one unit in the last place: the certificate is for another mesh.
/// ```
/// use hexfill_check::{CertificateError, Judged, certify, verify_certificate};
/// use hexfill_mesh::Context;
///
/// let hexes = [[0, 1, 2, 3, 4, 5, 6, 7]];
/// let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
/// let mut points = corners.map(|p| p.map(f64::from));
/// let ctx = Context::default();
/// let text = certify(&Judged::connectivity(8, &hexes).with_points(&points), &ctx)?.to_json();
/// let cube = Judged::connectivity(8, &hexes).with_points(&points);
/// assert_eq!(verify_certificate(&text, &cube, &ctx)?.det_j_positive, 1);
///
/// points[6][0] = points[6][0].next_up();
/// let moved = Judged::connectivity(8, &hexes).with_points(&points);
/// assert!(matches!(verify_certificate(&text, &moved, &ctx), Err(CertificateError::OtherMesh { .. })));
/// # Ok::<(), CertificateError>(())
/// ```
pub fn certify(input: &Judged<'_>, ctx: &Context<'_>) -> Result<Certificate, CertificateError> {
    certificate_of(input, &judge(input, &Options::default(), ctx))
}

/// The certificate that a report of this very input supports; saves judging twice.
///
/// # Errors
/// [`CertificateError::NotValid`] if the report does not support one.
pub fn certificate_of(input: &Judged<'_>, report: &Report) -> Result<Certificate, CertificateError> {
    let quality = report.geometry.as_ref().and_then(|g| g.quality.as_ref());
    let (true, Some(quality)) = (report.passed(Level::L5), quality) else { return Err(not_valid(report)) };
    let ball = match report.facts.ball {
        Some(Ball::Yes) => "yes",
        Some(Ball::Homology) => "homology",
        Some(Ball::No) => "no",
        _ => "unknown",
    };
    let certificate = Certificate {
        format: FORMAT.into(),
        judge: report.version.into(),
        mesh: hash_mesh(input),
        surface: hash_surface(input),
        vertices: input.n_vertices as u64,
        hexes: input.hexes.len() as u64,
        boundary_quads: report.facts.boundary_quads.unwrap_or(0),
        ball: ball.into(),
        level: "L5".into(),
        det_j_positive: report.geometry.as_ref().map_or(0, |g| g.certified),
        scaled_jacobian: quality.certified_scaled_jacobian,
        corner_scaled_jacobian: quality.min_corner_scaled_jacobian,
        seal: String::new(),
    };
    Ok(certificate.sealed())
}

/// Checks a certificate against a mesh: reads it, compares the hashes, and recomputes every number in it.
///
/// # Errors
/// [`CertificateError`], which names what is wrong: the text, the seal, the mesh, the surface, or a number.
pub fn verify_certificate(json: &str, input: &Judged<'_>, ctx: &Context<'_>) -> Result<Certificate, CertificateError> {
    let given: Certificate = serde_json::from_str(json).map_err(|e| CertificateError::Unreadable {
        line: e.line(),
        column: e.column(),
        reason: e.to_string(),
    })?;
    if given.format != FORMAT {
        return Err(CertificateError::Format { given: given.format });
    }
    // Text first, then what it is about, then the numbers: the first thing that is wrong is the one that is named.
    // The seal is a checksum and no signature: who changes the text can seal it again, and is found by the numbers.
    if given.seal != given.expected_seal() {
        return Err(CertificateError::Altered);
    }
    let found = hash_mesh(input);
    if given.mesh != found {
        return Err(CertificateError::OtherMesh { expected: given.mesh, found });
    }
    let found = hash_surface(input);
    if given.surface != found {
        let name = |hash: Option<String>| hash.unwrap_or_else(|| "none".into());
        return Err(CertificateError::OtherSurface { expected: name(given.surface), found: name(found) });
    }
    let again = certify(input, ctx)?;
    let differs = |field, expected: String, found: String| {
        if expected == found { Ok(()) } else { Err(CertificateError::NotReproduced { field, expected, found }) }
    };
    differs("vertices", given.vertices.to_string(), again.vertices.to_string())?;
    differs("hexes", given.hexes.to_string(), again.hexes.to_string())?;
    differs("boundary_quads", given.boundary_quads.to_string(), again.boundary_quads.to_string())?;
    differs("ball", given.ball.clone(), again.ball)?;
    differs("level", given.level.clone(), again.level)?;
    differs("det_j_positive", given.det_j_positive.to_string(), again.det_j_positive.to_string())?;
    differs("scaled_jacobian", format!("{:?}", given.scaled_jacobian), format!("{:?}", again.scaled_jacobian))?;
    differs(
        "corner_scaled_jacobian",
        format!("{:?}", given.corner_scaled_jacobian),
        format!("{:?}", again.corner_scaled_jacobian),
    )?;
    Ok(given)
}
