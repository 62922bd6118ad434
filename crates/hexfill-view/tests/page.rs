//! The page: nothing from the user escapes its place, nothing is fetched, and the data come back bit for bit.

mod common;

use base64::Engine as _;
use common::{ball, grid};
use hexfill_mesh::{Facet, HexId, HexMesh};
use hexfill_view::{Groups, ViewInput, html, write_html};
use serde_json::Value;

fn input<'a>(shape: &'a common::Shape, title: &'a str) -> ViewInput<'a> {
    ViewInput {
        title,
        points: &shape.points,
        mesh: &shape.mesh,
        hex_values: None,
        shelling: None,
        groups: None,
        facts: &[],
    }
}

/// The data element of a page.
fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("<script type=\"application/json\" id=\"data\">").expect("a data element");
    let (json, _) = rest.split_once("</script>").expect("its end");
    serde_json::from_str(json).expect("JSON")
}

fn bytes(value: &Value) -> Vec<u8> {
    base64::engine::general_purpose::STANDARD.decode(value.as_str().expect("a string")).expect("base64")
}

fn floats(value: &Value) -> Vec<f64> {
    bytes(value).chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
}

/// Where a browser would see elements begin: `<` and a letter, `/` or `!`, outside the data and the bundle.
fn markup(page: &str) -> String {
    let (before, rest) = page.split_once("id=\"data\">").unwrap();
    let (_, rest) = rest.split_once("</script>\n<script>").unwrap();
    let (_, after) = rest.rsplit_once("</script>").unwrap();
    format!("{before}{after}")
}

#[test]
fn hostile_texts_stay_texts() {
    let shape = grid(1, 1, 1);
    let title = "</title></script><script>alert(\"1\")</script><!-- <!--data--> ' & \u{2028} \0 \u{1f600}";
    let facts = [
        ("<img src=x onerror=alert(1)>".to_string(), "</td></table></section>".to_string()),
        ("a".to_string(), "]]> --> </script>".to_string()),
    ];
    let name = "\"</script><script>";
    let page = html(&ViewInput { facts: &facts, hex_values: Some((name, &[1.0])), ..input(&shape, title) });
    let plain = html(&input(&shape, "t"));
    for mark in ["<script", "</script", "<img", "<!--", "onerror=alert(1)>", "</title", "</section"] {
        let count = |text: &str| text.matches(mark).count();
        assert_eq!(count(&page), count(&plain), "{mark} was let in");
    }
    assert_eq!(plain.matches("<!--").count(), 0, "a comment could swallow the end of a script");
    // Three elements: data, viewer, and nothing else; so the bundle has none either.
    assert_eq!((plain.matches("<script").count(), plain.matches("</script").count()), (2, 2));
    assert!(page.contains("<title>&lt;/title&gt;&lt;/script&gt;&lt;script&gt;alert(&quot;1&quot;)"));
    assert!(page.contains("<th scope=\"row\">&lt;img src=x onerror=alert(1)&gt;</th>"));
    let data = data(&page);
    assert_eq!(data["title"], title);
    assert_eq!(data["facts"][0][1], "</td></table></section>");
    assert_eq!(data["values"]["name"], name);
}

#[test]
fn nothing_is_fetched() {
    let page = html(&input(&ball(2, 1), "Ball"));
    assert!(page.contains(
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; \
         script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:\">"
    ));
    for word in [
        "fetch(",
        "XMLHttpRequest",
        "WebSocket(",
        "EventSource(",
        "sendBeacon",
        "importScripts",
        "import(",
        "@import",
        "url(",
    ] {
        assert!(!page.contains(word), "{word}");
    }
    let markup = markup(&page);
    for word in ["http://", "https://", "src=\"/", "href=", "<link", "<base", "<iframe"] {
        assert!(!markup.contains(word), "{word}");
    }
    // In the bundle, addresses only name XML languages.
    let addresses: Vec<&str> = page.match_indices("://").map(|(i, _)| &page[i - 5..i + 14]).collect();
    assert!(addresses.iter().all(|a| a.ends_with("://www.w3.org/")), "{addresses:?}");
    assert!(page.contains("The MIT License") && page.contains("three.js authors"), "the licence of three.js is kept");
}

#[test]
fn the_data_come_back() {
    let shape = ball(3, 2);
    let values: Vec<f64> =
        (0..shape.mesh.n_hexes()).map(|h| if h == 5 { f64::NAN } else { 1.0 / (h as f64 - 7.5) }).collect();
    let order = common::facet_order(&shape.mesh);
    let facts = [("time".to_string(), "3 s".to_string())];
    let page = html(&ViewInput {
        hex_values: Some(("Scaled Jacobian", &values)),
        shelling: Some(&order),
        facts: &facts,
        ..input(&shape, "Ball")
    });
    let data = data(&page);
    assert_eq!((data["vertices"].as_u64(), data["hexes"].as_u64()), (Some(shape.points.len() as u64), Some(135)));
    let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&floats(&data["points"])), bits(shape.points.as_flattened()));
    assert_eq!(bits(&floats(&data["values"]["data"])), bits(&values));
    assert_eq!((data["values"]["low"].as_f64(), data["values"]["high"].as_f64()), (Some(0.0), Some(1.0)));
    let order_back: Vec<u32> =
        bytes(&data["shelling"]).chunks_exact(4).map(|b| u32::from_le_bytes(b.try_into().unwrap())).collect();
    assert_eq!(order_back, order.iter().map(|h| h.0).collect::<Vec<_>>());
    assert_eq!(data["problems"], serde_json::json!([]));
    assert_eq!(
        page,
        html(&ViewInput {
            hex_values: Some(("Scaled Jacobian", &values)),
            shelling: Some(&order),
            facts: &facts,
            ..input(&shape, "Ball")
        })
    );
}

/// Groups name their facets, walls inside count on both sides, and pictures take their colours.
#[test]
fn groups_of_quads_come_back() {
    let shape = grid(2, 1, 1);
    let quads = shape.mesh.boundary_quads_raw();
    let wall = (0..6).map(|side| Facet::new(HexId(0), side)).find(|f| shape.mesh.neighbour(*f).is_some()).unwrap();
    let wall = shape.mesh.facet_vertices(wall).map(|v| v.0);
    let all: Vec<[u32; 4]> = quads.iter().copied().chain([wall, [0, 1, 2, 90]]).collect();
    let tags: Vec<i64> = (0..12).map(|i| [-3, 0, 7, 0, 0, 0, 0, 0, 0, 0, 9, 8][i]).collect();
    let name = |tag: i64| format!("<{tag}>");
    for first in [false, true] {
        let groups = Groups::new(&shape.mesh, &all, &tags, name, first).unwrap();
        let with = ViewInput { groups: Some(&groups), ..input(&shape, "groups") };
        let data = data(&html(&with));
        assert_eq!(data["groups"]["names"], serde_json::json!(["<-3>", "<7>", "<9>"]));
        assert_eq!(
            (data["groups"]["first"].as_bool(), data["groups"]["colours"][0][0].as_u64()),
            (Some(first), Some(230))
        );
        let ids = |key: &str| -> Vec<u32> {
            let bytes = bytes(&data["groups"][key]);
            bytes.chunks_exact(4).map(|b| u32::from_le_bytes(b.try_into().unwrap())).collect()
        };
        let (facets, of) = (ids("facets"), ids("of"));
        assert!(facets.is_sorted() && facets.len() == 4 && of.iter().filter(|g| **g == 2).count() == 2);
        let plain = hexfill_view::png(&input(&shape, ""), 320, 160);
        assert_eq!(hexfill_view::png(&with, 320, 160) == plain, !first);
    }
    assert_eq!(Groups::new(&shape.mesh, &quads, &[0; 10], name, true), None);
}

/// Both pages are whole and escaped once; the picture has both halves.
#[test]
fn two_meshes_stand_beside_each_other() {
    let (left, right) = (grid(2, 1, 1), ball(2, 1));
    let (left, right) = (input(&left, "a \"b\""), input(&right, "<c>"));
    let mut page = Vec::new();
    hexfill_view::write_pair_html([&left, &right], &mut page).unwrap();
    let page = String::from_utf8(page).unwrap();
    assert!(page.contains("<title>a &quot;b&quot; | &lt;c&gt;</title>"));
    let frames: Vec<&str> = page.split("srcdoc=\"").skip(1).map(|rest| rest.split_once('"').unwrap().0).collect();
    assert_eq!(frames.len(), 2);
    for (frame, input) in frames.iter().zip([&left, &right]) {
        let text = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#39;", "'"), ("&amp;", "&")];
        let inner = text.iter().fold((*frame).to_owned(), |text, (from, to)| text.replace(from, to));
        assert_eq!(inner, html(input));
    }
    let picture = hexfill_view::pair_png([&left, &right], 400, 200);
    assert_eq!(picture[16..24], [0, 0, 1, 0x90, 0, 0, 0, 200]);
    assert_eq!(hexfill_view::pair_png([&left, &right], 400, 200), picture);
    assert_ne!(hexfill_view::pair_png([&right, &left], 400, 200), picture);
}

#[test]
fn corners_take_as_many_bytes_as_they_need() {
    for (n, width) in [(256, 1), (257, 2), (65_536, 2), (65_537, 4)] {
        let hex = [0, 1, 2, 3, 4, 5, 6, n as u32 - 1];
        let mesh = HexMesh::try_new(n, &[hex]).unwrap();
        let shape = common::Shape { mesh, points: vec![[0.0; 3]; n] };
        let data = data(&html(&input(&shape, "wide")));
        assert_eq!(data["corner_bytes"], width);
        let back: Vec<u32> = bytes(&data["corners"])
            .chunks_exact(width)
            .map(|b| b.iter().rev().fold(0, |n, &b| n << 8 | u32::from(b)))
            .collect();
        assert_eq!(back, hex);
    }
}

#[test]
fn what_does_not_fit_is_left_out_and_named() {
    let mut shape = grid(2, 1, 1);
    shape.points[2] = [0.0, f64::NAN, 0.0];
    shape.points.pop();
    let input = ViewInput {
        hex_values: Some(("volume", &[1.0])),
        shelling: Some(&[HexId(0), HexId(0)]),
        ..input(&shape, "broken")
    };
    let problems = input.problems();
    assert_eq!(problems.len(), 3, "{problems:?}");
    assert!(problems[0].starts_with("1 of 2 hexes have a corner without a finite position"));
    assert!(problems[1].contains("\"volume\" has 1 values for 2 hexes"));
    assert!(problems[2].contains("no order of the 2 hexes"));
    let data = data(&html(&input));
    assert_eq!(data["problems"].as_array().unwrap().len(), 3);
    assert!(data["values"].is_null() && data["shelling"].is_null());
    let points = floats(&data["points"]);
    assert_eq!(points.len(), 3 * 12);
    assert!(points[6..9].iter().all(|x| x.is_nan()) && points[33..].iter().all(|x| x.is_nan()));
    for order in [vec![HexId(0)], vec![HexId(0), HexId(2)], vec![]] {
        assert_eq!(ViewInput { shelling: Some(&order), hex_values: None, ..input }.problems().len(), 2);
    }
}

#[test]
fn an_empty_mesh_makes_a_page() {
    let shape = common::Shape { mesh: HexMesh::try_new(0, &[]).unwrap(), points: vec![] };
    assert_eq!(data(&html(&input(&shape, "")))["hexes"], 0);
}

#[test]
fn an_error_of_the_writer_comes_back() {
    let shape = grid(1, 1, 1);
    let mut full = [0u8; 100];
    assert!(write_html(&input(&shape, "t"), &mut full.as_mut_slice()).is_err());
    let mut page = Vec::new();
    write_html(&input(&shape, "t"), &mut page).unwrap();
    assert_eq!(String::from_utf8(page).unwrap(), html(&input(&shape, "t")));
}
