//! Numbers of nodes come back from every format, and new points get those that follow.

use hexfill_io::{Format, MeshData, read_from, write_to};

/// Two quads whose nodes are numbered by hand.
const SURFACE: &str = "*NODE\n70, 0, 0, 0\n12, 1, 0, 0\n13, 1, 1, 0\n9, 0, 1, 0\n500, 2, 0, 0\n501, 2, 1, 0\n*ELEMENT, TYPE=S4\n7, 70, 12, 13, 9\n8, 12, 500, 501, 13\n*NSET, NSET=ENDS\n70, 501\n";

fn read(text: &[u8], format: Format) -> MeshData {
    read_from(text, format, "memory").unwrap()
}

fn numbers(data: &MeshData) -> Option<&[f64]> {
    data.point_data.iter().find(|(name, _)| name == "node").map(|(_, values)| &values[..])
}

#[test]
fn numbers_come_back_from_every_format_that_has_them_or_data() {
    let data = read(SURFACE.as_bytes(), Format::Inp);
    let own = [70.0, 12.0, 13.0, 9.0, 500.0, 501.0];
    assert_eq!(numbers(&data), Some(&own[..]));
    for format in Format::ALL {
        let mut bytes = Vec::new();
        write_to(&mut bytes, format, &data).unwrap();
        let back = read(&bytes, format);
        let has_numbers = matches!(format, Format::Inp | Format::Nastran | Format::Unv | Format::Msh22 | Format::Msh41);
        if has_numbers || format.holds_data() {
            assert_eq!(numbers(&back), Some(&own[..]), "{format:?}");
            assert_eq!(back.quads, data.quads, "{format:?}");
        } else {
            assert!(data.losses(format).iter().any(|loss| loss.contains("data on points")), "{format:?}");
        }
        if has_numbers {
            assert!(!data.losses(format).iter().any(|loss| loss.contains("data on points")), "{format:?}");
        }
        if format.holds_point_tags() {
            assert_eq!(
                back.point_tags.as_ref().map(|tags| tags.iter().map(|t| *t != 0).collect::<Vec<_>>()),
                Some(vec![true, false, false, false, false, true]),
                "{format:?}"
            );
        }
    }
}

#[test]
fn new_points_follow_the_largest_number_and_wrong_numbers_are_data() {
    let mut data = read(SURFACE.as_bytes(), Format::Inp);
    data.points.extend([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0]]);
    data.point_tags = None;
    data.tag_names.clear();
    data.point_data[0].1.extend([f64::NAN; 2]);
    let mut bytes = Vec::new();
    write_to(&mut bytes, Format::Unv, &data).unwrap();
    assert_eq!(numbers(&read(&bytes, Format::Unv)).map(|n| &n[6..]), Some(&[502.0, 503.0][..]));
    // Twice the same number: these are no numbers of nodes, so a format without data loses them and says so.
    data.point_data[0].1[1] = 70.0;
    assert!(data.losses(Format::Unv).iter().any(|loss| loss.contains("data on points")));
    let mut bytes = Vec::new();
    write_to(&mut bytes, Format::Inp, &data).unwrap();
    assert_eq!(numbers(&read(&bytes, Format::Inp)), None);
}

#[test]
fn nodes_between_corners_are_numbered_after_all_others() {
    let data = read(SURFACE.as_bytes(), Format::Inp).into_quadratic().unwrap();
    let mut bytes = Vec::new();
    write_to(&mut bytes, Format::Inp, &data).unwrap();
    let back = read(&bytes, Format::Inp).linearised();
    assert_eq!(numbers(&back).map(|n| &n[..6]), Some(&[70.0, 12.0, 13.0, 9.0, 500.0, 501.0][..]));
}
