//! `hexfill enumerate N --gallery FILE`.

mod common;

use common::hexfill;

#[test]
fn every_small_mesh_is_drawn_or_says_why_not() {
    let dir = tempfile::tempdir().unwrap();
    let (code, out, err) = hexfill(dir.path(), &["enumerate", "4", "--gallery", "g.html"]);
    assert!(code == 0 && err.contains("wrote g.html: 24 of 24 objects"), "{err}");
    let page = std::fs::read_to_string(dir.path().join("g.html")).unwrap();
    // 12 balls (the book's table); the other 12 are rings.
    assert_eq!((page.matches("<figure>").count(), page.matches("<svg ").count()), (24, 12));
    assert_eq!(page.matches(": a ball</b>").count(), 12);
    assert_eq!(page.matches("not drawn: the boundary is no sphere (genera 1)").count(), 12);
    assert!(out.lines().all(|signature| page.contains(&format!("<code>{signature}</code>"))), "{out}");
    assert!(!page.contains("left out") && !page.contains("<script"));
}

#[test]
fn a_long_gallery_says_what_is_left_out() {
    let dir = tempfile::tempdir().unwrap();
    let (code, _, err) = hexfill(dir.path(), &["enumerate", "5", "--gallery", "g.html", "-o", "all.txt"]);
    assert!(code == 0 && err.contains("200 of 240 objects"), "{err}");
    let page = std::fs::read_to_string(dir.path().join("g.html")).unwrap();
    assert!(page.matches("<figure>").count() == 200 && page.contains("The first 200 are shown, 40 are left out"));
    for (file, word) in [("g.pdf", "ends in .html"), ("no/g.html", "does not exist")] {
        let (code, out, err) = hexfill(dir.path(), &["enumerate", "3", "--gallery", file]);
        assert!(code == 2 && out.is_empty() && err.contains(word), "{err}");
    }
}
