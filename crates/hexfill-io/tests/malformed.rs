//! Wrong input: each case names the place, what is wrong, and never panics or allocates on a claim.

mod common;

use hexfill_io::{Encoding, Format, MeshData, ReadError, read_from, read_path, write_path, write_to_with};
use std::time::Instant;

fn error(format: Format, text: impl AsRef<[u8]>) -> ReadError {
    match read_from(text.as_ref(), format, "in.file") {
        Ok(mesh) => panic!("{format}: read {mesh:?} from {}", String::from_utf8_lossy(text.as_ref())),
        Err(e) => e,
    }
}

/// The message has all the parts.
#[track_caller]
fn says(format: Format, text: impl AsRef<[u8]>, parts: &[&str]) {
    let message = error(format, text).to_string();
    for part in parts {
        assert!(message.contains(part), "{format}: `{part}` is not in: {message}");
    }
}

fn written(format: Format, encoding: Encoding) -> Vec<u8> {
    let mut file = Vec::new();
    write_to_with(&mut file, format, &common::chiral_for(format), encoding).unwrap();
    file
}

#[test]
fn empty_files() {
    for format in Format::ALL {
        for text in ["", "\n", " \n\r\n\t"] {
            let e = error(format, text);
            assert!(matches!(e, ReadError::Empty { .. }), "{format} {text:?}: {e}");
            assert!(e.to_string().contains(format.title()), "{e}");
        }
    }
}

#[test]
fn truncated_files_are_refused_at_every_line() {
    for format in Format::ALL {
        let file = written(format, Encoding::Text);
        let mesh = read_from(file.as_slice(), format, "whole").unwrap();
        let ends: Vec<usize> = (0..file.len()).filter(|&i| file[i] == b'\n').collect();
        for &end in &ends[..ends.len() - 1] {
            match read_from(&file[..=end], format, "cut.file") {
                Err(e) => assert!(e.to_string().contains("cut.file"), "{e}"),
                // OBJ and INP have no counts, MEDIT notes the missing end; attributes may be cut off whole.
                Ok(part) => {
                    let told = part.notes.iter().any(|n| n.contains("End"));
                    // (OVM knows hexes up to rotation without its last section.)
                    let sets = |m: &MeshData| {
                        let mut hexes = m.hexes.clone();
                        hexes.iter_mut().for_each(|h| h.sort_unstable());
                        hexes
                    };
                    let attributes_cut = part.quads == mesh.quads && sets(&part) == sets(&mesh);
                    let uncounted = matches!(format, Format::Obj | Format::Inp | Format::Nastran | Format::Unv);
                    assert!(told || attributes_cut || uncounted, "{format} cut at byte {end}: {part:?}");
                }
            }
        }
    }
}

#[test]
fn coordinates_must_be_finite() {
    for (format, encoding) in [
        (Format::Obj, Encoding::Text),
        (Format::Off, Encoding::Text),
        (Format::Ply, Encoding::Text),
        (Format::Vtk, Encoding::Text),
        (Format::Vtu, Encoding::Text),
        (Format::Medit, Encoding::Text),
        (Format::Msh22, Encoding::Text),
        (Format::Msh41, Encoding::Text),
        (Format::Inp, Encoding::Text),
        (Format::Ovm, Encoding::Text),
    ] {
        let text = String::from_utf8(written(format, encoding)).unwrap();
        // 1.75 occurs once, as a coordinate of point 6.
        let line = text.lines().position(|l| l.contains("1.75")).unwrap() + 1;
        for bad in ["nan", "NaN", "inf", "-Infinity", "1e999"] {
            let e = error(format, text.replacen("1.75", bad, 1));
            assert!(matches!(e, ReadError::NotFinite { .. }), "{format} {bad}: {e}");
            assert!(e.to_string().contains(&format!("in.file:{line}: ")), "{format}, line {line}: {e}");
            let parsed = bad.parse::<f64>().unwrap().to_string();
            assert!(e.to_string().contains(bad) || e.to_string().contains(&parsed), "{e}");
        }
        let e = error(format, text.replacen("1.75", "1.7x5", 1));
        assert!(e.to_string().contains("1.7x5"), "{format}: {e}");
        assert!(e.to_string().contains(&format!("in.file:{line}: ")), "{format}, line {line}: {e}");
    }
    // Binary: found by value.
    for format in [Format::Ply, Format::Vtk] {
        let file = written(format, Encoding::Binary);
        let value = if format == Format::Ply { 1.75f64.to_le_bytes() } else { 1.75f64.to_be_bytes() };
        let at = file.windows(8).position(|w| w == value).unwrap();
        let mut bad = file.clone();
        bad[at..at + 8].fill(0xff);
        let e = error(format, bad);
        assert!(matches!(e, ReadError::NotFinite { .. }), "{format}: {e}");
        assert!(e.to_string().contains('6'), "the point is named: {e}");
    }
    let json = r#"{"points": [[0, 0, 1e999]], "hexes": []}"#;
    says(Format::Json, json, &["in.file:1", "out of range"]);
    let mut mesh = common::chiral();
    mesh.points[6][2] = f64::NAN;
    let message = write_to_with(Vec::new(), Format::Vtk, &mesh, Encoding::Text).unwrap_err().to_string();
    assert!(message.contains("coordinate z of point 6"), "{message}");
}

#[test]
fn indices_must_exist() {
    let v = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    says(Format::Obj, format!("{v}f 1 2 3 5\n"), &["in.file:5", "vertex 5", "1 to 4"]);
    says(Format::Obj, format!("{v}f 1 2 3 0\n"), &["in.file:5", "vertex 0", "1 to 4"]);
    says(Format::Obj, format!("{v}f 1 2 3 -5\n"), &["in.file:5", "vertex -5", "-4 to -1"]);
    says(Format::Obj, format!("{v}f 1 2 3 99999999999\n"), &["in.file:5", "99999999999"]);
    says(Format::Obj, "f 1 2 3 4\n", &["points"]);
    says(Format::Off, "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 4\n", &["in.file:7", "vertex 4", "0 to 3"]);
    says(Format::Off, "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 -1\n", &["in.file:7", "vertex -1"]);
    let ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n\
               element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0 7\n";
    says(Format::Ply, ply, &["in.file:11", "vertex 7", "0 to 0"]);
    says(
        Format::Medit,
        "MeshVersionFormatted 2\nDimension 3\nVertices\n1\n0 0 0 0\nQuadrilaterals\n1\n1 1 1 0 0\nEnd\n",
        &["in.file:8", "vertex 0", "1 to 1"],
    );
    let msh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n7 0 0 0\n$EndNodes\n$Elements\n1\n1 3 2 0 1 7 7 7 8\n$EndElements\n";
    says(Format::Msh22, msh, &["in.file:10", "node 8", "7 to 7"]);
    says(Format::Msh22, msh.replace("7 0 0 0", "9223372036854775807 0 0 0"), &["in.file:10", "node 7"]);
    says(Format::Inp, "*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=S4\n1, 1, 1, 1, 2\n", &["in.file:4", "2, which no node has"]);
    let vtk = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 double\n0 0 0\nCELLS 1 4\n3 0 0 1\nCELL_TYPES 1\n5\n";
    says(Format::Vtk, vtk, &["in.file:8", "point 1", "0 to 0"]);
    says(Format::Json, r#"{"points": [[0,0,0]], "boundary_quads": [[0,0,0,1]]}"#, &["point 1", "0 to 0"]);
    says(Format::Json, r#"{"boundary_quads": [[0,1,2,-1]]}"#, &["in.file:1", "-1"]);
    says(Format::Json, r#"{"boundary_quads": [[0,1,2,1000000000]]}"#, &["1000000000", "renumber"]);
}

/// Most address space this process has ever had, in bytes (Linux; elsewhere 0): reserving counts, touched or not.
fn peak_memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmPeak:")).unwrap_or_default();
    line.split_whitespace().next().and_then(|n| n.parse::<u64>().ok()).unwrap_or(0) * 1024
}

#[test]
fn a_small_file_cannot_claim_a_huge_mesh() {
    let started = Instant::now();
    let before = peak_memory();
    let n = 1_000_000_000;
    let head = "MeshVersionFormatted 2\nDimension 3\n";
    let cases: Vec<(Format, String)> = vec![
        (Format::Off, format!("OFF\n{n} 1 0\n0 0 0\n")),
        (Format::Off, format!("OFF\n1 {n} 0\n0 0 0\n3 0 0 0\n")),
        (Format::Off, format!("OFF\n1 1 0\n0 0 0\n{n} 0 0 0\n")),
        (Format::Medit, format!("{head}Vertices\n{n}\n0 0 0 0\n")),
        (Format::Medit, format!("{head}Vertices\n1\n0 0 0 0\nHexahedra\n{n}\n1 1 1 1 1 1 1 1 0\n")),
        (Format::Msh22, format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{n}\n1 0 0 0\n")),
        (Format::Msh41, format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {n} 1 {n}\n3 1 0 {n}\n1\n2\n")),
        (Format::Vtk, format!("# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS {n} float\n1 2 3\n")),
        (Format::Vtk, format!("# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS {n} float\n1 2 3\n")),
        (
            Format::Vtk,
            format!(
                "# vtk DataFile Version 5.1\n\nBINARY\nDATASET POLYDATA\nPOINTS 0 float\n\nPOLYGONS {n} {n}\nOFFSETS vtktypeint64\n"
            ),
        ),
        (Format::Ovm, format!("OVM ASCII\nVertices\n{n}\n0 0 0\n")),
        (
            Format::Ply,
            format!(
                "ply\nformat ascii 1.0\nelement vertex {n}\nproperty double x\nproperty double y\nproperty double z\nend_header\n0 0 0\n"
            ),
        ),
        (
            Format::Ply,
            format!(
                "ply\nformat binary_little_endian 1.0\nelement vertex {n}\nproperty double x\nproperty double y\nproperty double z\nend_header\n0 0 0\n"
            ),
        ),
        (
            Format::Vtu,
            format!(
                "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"{n}\" NumberOfCells=\"{n}\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0</DataArray></Points></Piece></UnstructuredGrid></VTKFile>"
            ),
        ),
        (
            Format::Inp,
            format!(
                "*NODE\n1, 0, 0, 0\n*ELSET, ELSET=A, GENERATE\n1, {n}, 1\n*ELSET, ELSET=A, GENERATE\n1, 9223372036854775807, 1\n"
            ),
        ),
    ];
    for (format, text) in cases {
        let e = error(format, &text).to_string();
        assert!(e.starts_with("in.file"), "{e}");
    }
    let huge = "99999999999";
    says(Format::Off, format!("OFF\n{huge} 1 0\n"), &["in.file:2", huge, "4294967295"]);
    says(Format::Off, "OFF\n-1 1 0\n", &["in.file:2", "-1"]);
    // A billion points would be 24 GB, a billion faces 16 GB. (Other tests, and arenas for their threads, run beside this one.)
    assert!(peak_memory() - before < 3 << 30, "{} bytes more", peak_memory() - before);
    assert!(started.elapsed().as_secs() < 5, "no time is spent on claims");
}

#[test]
fn repeated_sections_are_refused() {
    let medit = String::from_utf8(written(Format::Medit, Encoding::Text)).unwrap();
    let again = medit.replace("End\n", "Vertices\n1\n0 0 0 0\nEnd\n");
    says(Format::Medit, again, &["each section once", "Vertices"]);
    let vtk = String::from_utf8(written(Format::Vtk, Encoding::Text)).unwrap();
    says(Format::Vtk, vtk.replace("CELL_TYPES", "POINTS 0 double\nCELL_TYPES"), &["POINTS again"]);
    says(Format::Vtk, vtk.replace("CELL_TYPES", "CELLS 0 0\nCELL_TYPES"), &["each section once", "CELLS"]);
    for format in [Format::Msh22, Format::Msh41] {
        let msh = String::from_utf8(written(format, Encoding::Text)).unwrap();
        says(format, format!("{msh}$Nodes\n0\n$EndNodes\n"), &["each section once", "$Nodes again"]);
    }
    let ply = "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nelement vertex 0\nend_header\n";
    says(Format::Ply, ply, &["in.file:5", "each element once"]);
    says(Format::Json, r#"{"hexes": [], "hexes": []}"#, &["duplicate"]);
    let vtu = String::from_utf8(written(Format::Vtu, Encoding::Text)).unwrap();
    let start = vtu.find("<Points>").unwrap();
    let end = vtu.find("</Points>").unwrap();
    let twice = format!("{}{}{}", &vtu[..end], &vtu[start + 9..end], &vtu[end..]);
    says(Format::Vtu, twice, &["each array once"]);
    let ovm = String::from_utf8(written(Format::Ovm, Encoding::Text)).unwrap();
    says(Format::Ovm, ovm.replace("Edges", "Vertices"), &["`Edges`", "`Vertices`"]);
}

#[test]
fn text_in_other_dress() {
    // CRLF, comments, blank lines, byte order mark: the same mesh.
    for format in Format::ALL {
        let text = String::from_utf8(written(format, Encoding::Text)).unwrap();
        let plain = read_from(text.as_bytes(), format, "plain").unwrap();
        let crlf = text.replace('\n', "\r\n");
        common::assert_same(&read_from(crlf.as_bytes(), format, "crlf").unwrap(), &plain, &format!("{format} CRLF"));
        let comment = match format {
            Format::Obj | Format::Off | Format::Medit | Format::Ovm => "  # a comment\n\n",
            _ => continue,
        };
        let commented = text.replacen('\n', &format!("\n{comment}"), 1).replacen("1.75", "1.75 # here\n", 0);
        common::assert_same(&read_from(commented.as_bytes(), format, "comments").unwrap(), &plain, format.name());
    }
    let inp = "** first\n*Heading\n anything, 1\n*Node , nset = all\n 1,0.,0.,0.\n** between\n2,1.D0,0.\n3,1,1,0\n4,0,1\n\
               *Element,type=s4r , elset= \"skin\"\n1,1,2,\n3,4\n*Step\n*end step\n";
    let mesh = read_from(inp.as_bytes(), Format::Inp, "i").unwrap();
    assert_eq!((mesh.points.len(), mesh.quads.as_slice()), (4, [[0, 1, 2, 3]].as_slice()));
    assert_eq!(mesh.points[1], [1.0, 0.0, 0.0]);
}

#[test]
fn obj_in_all_its_forms() {
    let obj = "\u{feff}# head\r\nmtllib a.mtl\r\no thing\nv 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nvt 0 0\nvn 0 0 1\nv 1 1 \\\n 0\nv 0 1 0\n\
               g side\nusemtl red\ns off\nf 1/1/1 2//1 3/1 4\nf -4 -3 -2 \\\n-1\nf 5 6 7 8\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nl 1 2\nf 1 2 3\nf 1\\\n 2 3\n";
    let mesh = read_from(obj.as_bytes(), Format::Obj, "o").unwrap();
    assert_eq!(mesh.quads, [[0, 1, 2, 3], [0, 1, 2, 3], [4, 5, 6, 7]]);
    assert_eq!(mesh.points.len(), 8);
    assert_eq!(mesh.other_faces.len(), 2);
    assert_eq!(mesh.other_faces[0].position, 3);
    assert!(mesh.notes.iter().any(|n| n.contains("1 line and point elements")), "{:?}", mesh.notes);
    says(Format::Obj, "v 0 0\n", &["in.file:1", "coordinate z"]);
    says(Format::Obj, "v 0 0 0\nf 1 1\n", &["in.file:2", "three or more"]);
    says(Format::Obj, "v 0 0 0\nf 1 1 a\n", &["in.file:2", "`a`"]);
    says(Format::Obj, "solid cube\n", &["in.file:1", "OBJ"]);
    let groups = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng inlet\nf 1 2 3 4\ng tag_1\nf 1 2 3 4\ng outlet wall\nf 1 2 3 4\ng\nf 1 2 3 4\n";
    let mesh = read_from(groups.as_bytes(), Format::Obj, "o").unwrap();
    assert_eq!(mesh.quad_tags, Some(vec![2, 1, 3, 0]));
    let names: Vec<(i64, &str)> = mesh.tag_names.iter().map(|n| (n.tag, n.name.as_str())).collect();
    assert_eq!(names, [(2, "inlet"), (3, "outlet"), (3, "wall")]);
    let objects =
        "o a box\nusemtl red\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nusemtl None\ng default\nf 1 2 3 4\n";
    let mesh = read_from(objects.as_bytes(), Format::Obj, "o").unwrap();
    let names: Vec<(i64, &str)> = mesh.tag_names.iter().map(|n| (n.tag, n.name.as_str())).collect();
    assert_eq!((mesh.quad_tags, names), (Some(vec![2, 1]), vec![(1, "a box"), (2, "a box"), (2, "red")]));
}

#[test]
fn files_that_are_something_else() {
    let cases: [(Format, &[u8], &[&str]); 14] = [
        (Format::Obj, b"\x89PNG\r\n\x1a\n\0\0", &["in.file:1", "not text"]),
        (Format::Vtk, b"<VTKFile type=\"x\">", &["in.file:1", ".vtu"]),
        (Format::Vtk, b"# vtk DataFile Version 9.9\nt\nASCII\n", &["9.9", "5.1"]),
        (
            Format::Vtk,
            b"# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_GRID\n",
            &["STRUCTURED_GRID", "convert"],
        ),
        (Format::Msh22, b"(0 \"Fluent\")\n(2 3)\n", &["ANSYS/Fluent", "Gmsh 2.2"]),
        (Format::Msh41, b"$MeshFormat\n4 0 8\n$EndMeshFormat\n", &["MSH `4`", "4.1"]),
        (Format::Msh22, b"$NOD\n1\n", &["MSH 1", "msh22"]),
        (Format::Medit, b"MFEM mesh v1.0\n", &["MFEM"]),
        (Format::Medit, b"\x01\0\0\0\x02\0\0\0", &["meshb"]),
        (Format::Inp, b"8 1 0 0 0\n1 0 0 0\n", &["AVS UCD"]),
        (Format::Off, b"OFF BINARY\n\0\0", &["binary OFF"]),
        (Format::Ovm, b"OVMB\n", &["ovmb"]),
        (Format::Vtu, b"<html></html>", &["VTK XML"]),
        (Format::Vtu, b"<VTKFile type=\"ImageData\"></VTKFile>", &["ImageData", "unstructured"]),
    ];
    for (format, bytes, parts) in cases {
        says(format, bytes, parts);
    }
    for format in Format::ALL {
        let message = error(format, b"\xff\xfe\x00\x01 \xc3\x28 hello\n").to_string();
        assert!(message.starts_with("in.file"), "{message}");
    }
}

#[test]
fn voxels_and_pixels_are_put_in_order() {
    let mut text = "# vtk DataFile Version 2.0\nvoxel\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n".to_owned();
    for z in 0..2 {
        for y in 0..2 {
            for x in 0..2 {
                text.push_str(&format!("{x} {y} {z} "));
            }
        }
    }
    text.push_str("\nCELLS 2 14\n8 0 1 2 3 4 5 6 7\n4 0 1 2 3\nCELL_TYPES 2\n11 8\n");
    let mesh = read_from(text.as_bytes(), Format::Vtk, "v").unwrap();
    assert_eq!(mesh.hexes, [[0, 1, 3, 2, 4, 5, 7, 6]]);
    assert_eq!(mesh.quads, [[0, 1, 3, 2]]);
    says(Format::Vtk, text.replace("\n11 8", "\n12 9 1"), &["a section of legacy VTK", "`1`"]);
    says(Format::Vtk, text.replace("\n11 8", "\n13 9"), &["6 nodes", "8 for cell 0"]);
    says(Format::Vtk, text.replace("CELLS 2 14", "CELLS 2 15"), &["15 numbers for 2 cells", "14"]);
}

#[test]
fn names_and_paths() {
    let message = read_path("surface.stl".as_ref(), None).unwrap_err().to_string();
    assert!(message.contains("STL holds triangles") && message.contains("quads"), "{message}");
    let message = read_path("surface.xyz".as_ref(), None).unwrap_err().to_string();
    assert!(message.contains("`xyz`") && message.contains(".obj, .off, .ply, .vtk"), "{message}");
    let message = read_path("/nonexistent/surface.obj".as_ref(), None).unwrap_err().to_string();
    assert!(message.contains("/nonexistent/surface.obj"), "{message}");
    let directory = std::env::temp_dir();
    assert!(read_path(&directory, Some(Format::Obj)).is_err());
    let message = write_path(&directory.join("a.vtp"), None, &common::chiral()).unwrap_err().to_string();
    assert!(message.contains("`.vtu`"), "{message}");
    assert!(write_path("/nonexistent/a.vtk".as_ref(), None, &common::chiral()).is_err());
}

#[test]
fn what_a_format_cannot_hold_is_refused_and_the_old_file_stays() {
    let path = std::env::temp_dir().join(format!("hexfill-io-refused-{}.obj", std::process::id()));
    std::fs::write(&path, "old").unwrap();
    let message = write_path(&path, None, &common::chiral()).unwrap_err().to_string();
    assert!(message.contains("2 cells (2 hexes)"), "{message}");
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
    std::fs::remove_file(&path).unwrap();

    let refuse = |mesh: &MeshData, format: Format, encoding: Encoding, parts: &[&str]| {
        let message = write_to_with(Vec::new(), format, mesh, encoding).unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in: {message}");
        }
    };
    let mut mesh = common::chiral();
    refuse(&mesh, Format::Medit, Encoding::Binary, &["binary"]);
    mesh.hex_tags = Some(vec![1 << 40, 0]);
    refuse(&mesh, Format::Medit, Encoding::Text, &["1099511627776", "32-bit"]);
    mesh.hex_tags = Some(vec![1]);
    refuse(&mesh, Format::Vtk, Encoding::Text, &["hex_tags has 1 values instead of 2"]);
    mesh.hex_tags = None;
    mesh.quads[0][0] = 12;
    refuse(&mesh, Format::Vtk, Encoding::Text, &["index 12", "12 points"]);
    assert_eq!(common::mixed().losses(Format::Obj).len(), 0);
    assert_eq!(common::chiral().losses(Format::Off).len(), 2);
}

#[test]
fn nastran_says_what_is_wrong() {
    let grids = "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n";
    let with = |cards: &str| format!("{grids}{cards}ENDDATA\n");
    let f = Format::Nastran;
    says(f, with("CQUAD4,1,1,1,2,3,9\n"), &["in.file:6: ", "9, which none has", "add the GRID"]);
    says(f, with("CQUAD4,1,1,1,2,3\n"), &["in.file:6: ", "the number of a point", "nothing"]);
    says(f, with("CQUAD4  one     1       1       2       3       4\n"), &["in.file:6: ", "`one`", "8 columns"]);
    says(f, with("GRID,5,2,0.,0.,1.\n"), &["in.file:6: ", "coordinate system 2", "basic"]);
    says(f, with("GRDSET,,7\n"), &["in.file:6: ", "coordinate system 7"]);
    says(f, with("GRID,4,,0.,2.,0.\n"), &["in.file:6: ", "4 twice"]);
    says(f, with("GRID,5,,0.,1.x,0.\n"), &["in.file:6: ", "coordinate y", "`1.x`"]);
    says(f, with("GRID,5,,0.,nan,0.\n"), &["in.file:6: ", "y is nan", "finite"]);
    says(f, with("INCLUDE 'other.bdf'\n"), &["in.file:6: ", "INCLUDE", "paste"]);
    says(f, "CEND\nBEGIN BULK\nENDDATA\n", &["GRID", "found none"]);
    says(f, "solid thing\n", &["in.file:1: ", "such as GRID", "extension"]);
}

#[test]
fn nastran_in_all_its_forms() {
    // A cube: small fields, wide ones, commas, tabs; continuations of each; numbers without the letter of the exponent.
    let text = "SOL 101\nCEND\nTITLE = cube\nBEGIN BULK\n$HMNAME COMP                   7\"skin\"\n$ANSA_NAME_COMMENT;9;PSOLID;core;\n\
                CHEXA   5       9       1       2       3       4       5       6       +A\n+A      7       8\n\
                GRID    1               0.0     0.      0.\nGRID*   2                               1.0             0.\n*       0.\n\
                grid,3,,10.-1,+1.D+0,,\nGRID,4,,0.,\n,1.\nGRID\t5\t\t0.\t0.\t1.\n\
                GRID*,6,,1.,0.,\n*,1.\nGRID,7,0,1.,1.,1.,0\nGRID    8               0.0     1.0     .1+1    $ the last\n\
                CQUAD4,1,7,1,4,3,2,0.0\nCQUAD8,2,7,5,6,7,8,1,2,\n+,3,4\nCTRIA3,3,7,1,2,3\nCBAR,4,1,1,2\nSPC1,1,123456,1,THRU,8\n\
                PSHELL,7,1,.1\nENDDATA\nGRID,1,,9.,9.,9.\n";
    let text = text.replace("GRID,4,,0.,\n,1.", "GRID,4,,0.,1.");
    let mesh = read_from(text.as_bytes(), Format::Nastran, "n").unwrap();
    let cube = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    assert_eq!(mesh.points, cube.map(|p| p.map(f64::from)));
    assert_eq!(
        (mesh.hexes.as_slice(), mesh.hex_tags.as_deref()),
        ([[0, 1, 2, 3, 4, 5, 6, 7]].as_slice(), Some(&[9][..]))
    );
    assert_eq!(mesh.quads, [[0, 3, 2, 1], [4, 5, 6, 7]]);
    assert_eq!((mesh.quad_tags, mesh.other_faces.len()), (Some(vec![7, 7]), 1));
    let names: Vec<(i64, &str)> = mesh.tag_names.iter().map(|n| (n.tag, n.name.as_str())).collect();
    assert_eq!(names, [(7, "skin"), (9, "core")]);
    assert!(mesh.notes.iter().any(|n| n.contains("1 elements of type CBAR")), "{:?}", mesh.notes);
}

#[test]
fn universal_files_say_what_is_wrong() {
    let f = Format::Unv;
    let nodes = "    -1\n  2411\n 1 1 1 11\n 0. 0. 0.\n 2 1 1 11\n 1. 0. 0.\n 3 0 1 11\n 1. 1.D0 0.\n    -1\n";
    let with = |more: &str| format!("{nodes}    -1\n  2412\n{more}    -1\n");
    says(f, with(" 1 91 1 1 7 3\n 1 2 4\n"), &["in.file:12: ", "4, which none has", "add the node"]);
    says(f, with(" 1 91 1 1 7 4\n 1 2 3 1\n"), &["in.file:12: ", "3 nodes of an element of type 91", "4"]);
    says(f, with(" 1 91 1 1 7 3\n 1 2\n"), &["in.file:14: ", "the nodes of an element", "end of the dataset"]);
    says(f, nodes.replace("3 0 1 11", "3 5 1 11"), &["in.file:7: ", "coordinate system 5"]);
    says(f, nodes.replace("3 0 1 11", "2 0 1 11"), &["in.file:8: ", "2 twice"]);
    says(f, nodes.replace("1.D0", "inf"), &["in.file:8: ", "y is inf"]);
    says(f, "    -1\n  2411\n 1 1 1 11\n 0. 0. 0.\n", &["ends too early", "`-1`"]);
    says(f, "    -1\n   151\n hello\n    -1\n", &["2411", "found none"]);
    says(f, "solid thing\n", &["in.file:1: ", "a line `-1`", "extension"]);
    let group = " 1 0 0 0 0 0 0 2\nwall\n 8 1 0 0\n";
    says(f, format!("{nodes}    -1\n  2467\n{group}    -1\n"), &["in.file:15: ", "members of a group"]);
}
