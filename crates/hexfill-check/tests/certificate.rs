//! Certificates hold for their mesh and for nothing else.

mod common;

use common::*;
use hexfill_check::{CertificateError, Judged, certify, verify_certificate};
use hexfill_mesh::Context;

fn sample() -> (Sample, Vec<[f64; 3]>) {
    let size = [3, 2, 2];
    let mut points = grid_points(size);
    let mut random = Random(8);
    for p in &mut points {
        *p = p.map(|x| x + 0.2 * (random.unit() - 0.5));
    }
    (grid(size), points)
}

#[test]
fn a_certificate_holds_for_its_mesh() {
    let (s, points) = sample();
    let ctx = Context::default();
    for input in [s.judged().with_points(&points), Judged { surface: None, ..s.judged().with_points(&points) }] {
        let made = certify(&input, &ctx).unwrap();
        assert_eq!((made.hexes, made.det_j_positive, made.ball.as_str()), (12, 12, "yes"));
        assert!(made.scaled_jacobian[0] > 0.3);
        assert_eq!(verify_certificate(&made.to_json(), &input, &ctx).unwrap(), made);
    }
}

#[test]
fn every_changed_digit_is_refused() {
    let (s, points) = sample();
    let ctx = Context::default();
    let input = s.judged().with_points(&points);
    let json = certify(&input, &ctx).unwrap().to_json();
    let mut tried = 0;
    for (i, c) in json.char_indices().filter(|(_, c)| c.is_ascii_digit()) {
        let other = if c == '7' { "3" } else { "7" };
        let mut text = json.clone();
        text.replace_range(i..i + 1, other);
        let error = verify_certificate(&text, &input, &ctx).unwrap_err();
        let clear = matches!(
            error,
            CertificateError::Altered | CertificateError::Format { .. } | CertificateError::Unreadable { .. }
        );
        assert!(clear, "{error}");
        tried += 1;
    }
    assert!(tried > 100);
}

#[test]
fn every_truncation_is_refused() {
    let (s, points) = sample();
    let ctx = Context::default();
    let input = s.judged().with_points(&points);
    let json = certify(&input, &ctx).unwrap().to_json();
    for end in 0..json.len() {
        let error = verify_certificate(&json[..end], &input, &ctx).unwrap_err();
        assert!(matches!(error, CertificateError::Unreadable { .. }), "{error}");
    }
    let more = json.replace("\"hexes\"", "\"extra\": 1,\n  \"hexes\"");
    assert!(matches!(verify_certificate(&more, &input, &ctx), Err(CertificateError::Unreadable { .. })));
}

#[test]
fn another_mesh_surface_or_verdict_is_refused() {
    let (s, points) = sample();
    let ctx = Context::default();
    let input = s.judged().with_points(&points);
    let json = certify(&input, &ctx).unwrap().to_json();

    let mut moved = points.clone();
    moved[4][2] = f64::from_bits(moved[4][2].to_bits() ^ 1);
    let error = verify_certificate(&json, &s.judged().with_points(&moved), &ctx).unwrap_err();
    assert!(matches!(error, CertificateError::OtherMesh { .. }), "{error}");

    let mut turned = s.clone();
    turned.surface[2].reverse();
    let error = verify_certificate(&json, &turned.judged().with_points(&points), &ctx).unwrap_err();
    assert!(matches!(error, CertificateError::OtherSurface { .. }), "{error}");
    let bare = Judged { surface: None, ..input };
    let error = verify_certificate(&json, &bare, &ctx).unwrap_err();
    assert!(matches!(error, CertificateError::OtherSurface { .. }), "{error}");

    // A forged certificate with a seal of its own: recomputing finds it out.
    let mut forged = certify(&input, &ctx).unwrap();
    forged.scaled_jacobian[0] += 0.01;
    let resealed = reseal(&forged.to_json());
    let error = verify_certificate(&resealed, &input, &ctx).unwrap_err();
    assert!(matches!(error, CertificateError::NotReproduced { field: "scaled_jacobian", .. }), "{error}");

    let flat: Vec<[f64; 3]> = points.iter().map(|p| [p[0], p[1], 0.0]).collect();
    let error = certify(&s.judged().with_points(&flat), &ctx).unwrap_err();
    assert!(error.to_string().contains("jacobian-not-positive"), "{error}");
    let error = certify(&s.judged(), &ctx).unwrap_err();
    assert!(error.to_string().contains("no positions"), "{error}");
}

/// What a forger would do: hash the certificate with an empty seal.
fn reseal(json: &str) -> String {
    let start = json.find("\"seal\": \"").unwrap() + 9;
    let end = start + json[start..].find('"').unwrap();
    let bare = format!("{}{}", &json[..start], &json[end..]);
    let seal = blake3::hash(bare.as_bytes()).to_hex().to_string();
    format!("{}{seal}{}", &json[..start], &json[end..])
}
