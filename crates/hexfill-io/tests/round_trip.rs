//! What is written is read back, to the bit, in every format.

mod common;

use common::{assert_same, chiral_for, mixed, named_for, with_any_first_corner, without_what_is_not_held};
use hexfill_io::{Encoding, Format, MeshData, OtherFace, TagOn, read_from, read_path, write_path_with, write_to_with};
use proptest::prelude::*;

fn round_trip(mesh: &MeshData, format: Format, encoding: Encoding) -> MeshData {
    let mut file = Vec::new();
    write_to_with(&mut file, format, mesh, encoding).unwrap_or_else(|e| panic!("{format}: {e}"));
    let mut back = read_from(file.as_slice(), format, &format!("test.{format}")).unwrap_or_else(|e| {
        panic!("{e}\n{}", String::from_utf8_lossy(&file[..file.len().min(3000)]));
    });
    if format == Format::Nastran {
        // Fields of 16 characters; that digits are lost is said.
        assert_eq!(back.points.len(), mesh.points.len());
        let mut rounded = 0;
        for (p, q) in back.points.iter_mut().zip(&mesh.points) {
            assert!(p.iter().zip(q).all(|(x, y)| (x - y).abs() <= 1e-8 * y.abs()), "{p:?} {q:?}");
            rounded += usize::from(p.map(f64::to_bits) != q.map(f64::to_bits));
            *p = *q;
        }
        let said = mesh.losses(format).iter().any(|loss| loss.contains(&format!("digits of {rounded} points")));
        assert!(said || rounded == 0);
    }
    back
}

fn flavours() -> Vec<(Format, Encoding)> {
    let text = Format::ALL.map(|f| (f, Encoding::Text));
    let binary = Format::ALL.into_iter().filter(|f| f.has_binary()).map(|f| (f, Encoding::Binary));
    text.into_iter().chain(binary).collect()
}

#[test]
fn chiral_mesh_with_tags_and_data() {
    for (format, encoding) in flavours() {
        let mesh = chiral_for(format);
        let back = with_any_first_corner(round_trip(&mesh, format, encoding), format);
        assert_same(&back, &with_any_first_corner(mesh, format), &format!("{format} {encoding:?}"));
    }
}

#[test]
fn names_of_groups_come_back() {
    for (format, encoding) in flavours() {
        let mut mesh = named_for(format);
        if matches!(format, Format::Msh22 | Format::Msh41) {
            mesh.tag_names.retain(|n| n.on != TagOn::Points); // Gmsh has no groups of single nodes
        }
        let mut lost = mesh.losses(format);
        lost.retain(|loss| !loss.contains("digits of"));
        assert!(lost.is_empty(), "{format}: {lost:?}");
        let mut back = with_any_first_corner(round_trip(&mesh, format, encoding), format);
        if format == Format::Msh22 {
            // One group an element: the names of several are joined.
            let joined = back.tag_names.iter_mut().find(|n| n.tag == 5).unwrap();
            assert_eq!(joined.name, "inlet+wall");
            joined.name = "inlet".to_owned();
            mesh.tag_names.retain(|n| !(n.tag == 5 && n.name == "wall"));
        }
        if format == Format::Inp {
            // Sets of hexes and surfaces on them are numbered together, surfaces last.
            let names = |m: &MeshData| -> Vec<Vec<String>> {
                let sorted = |t: &i64| {
                    let of_tag = m.tag_names.iter().filter(|n| n.on == TagOn::Faces && n.tag == *t);
                    let mut names: Vec<String> = of_tag.map(|n| n.name.clone()).collect();
                    names.sort();
                    names
                };
                m.quad_tags.iter().flatten().map(sorted).collect()
            };
            assert_eq!(names(&back), names(&mesh));
            back.quad_tags.clone_from(&mesh.quad_tags);
            back.tag_names.clone_from(&mesh.tag_names);
        }
        assert_same(&back, &with_any_first_corner(mesh, format), &format!("{format} {encoding:?}"));
    }
}

/// Cells of second order come back as their corners, with all that they carry.
#[test]
fn quadratic_cells_have_the_same_corners() {
    for (format, encoding) in flavours() {
        let mesh = chiral_for(format);
        let quadratic = mesh.clone().into_quadratic().unwrap();
        assert_eq!(quadratic.points.len(), 12 + 20);
        if !format.holds_quadratic() {
            let error = write_to_with(Vec::new(), format, &quadratic, encoding).unwrap_err().to_string();
            assert!(error.contains("second order") && error.contains(".vtu"), "{error}");
            continue;
        }
        for (mesh, quadratic) in [(mesh.clone(), quadratic.clone()), (mesh.surface_only(), quadratic.surface_only())] {
            let back = round_trip(&quadratic, format, encoding);
            assert_eq!(back.points.len(), 32);
            let back = with_any_first_corner(back, format);
            // Without hexes the nodes of inner edges are on nothing.
            let mut back = MeshData { middles: (12..32).collect(), ..back }.linearised();
            back.notes.clear();
            assert_same(&back, &with_any_first_corner(mesh, format), &format!("{format} {encoding:?}"));
        }
    }
}

#[test]
fn quadratic_cells_must_fit() {
    let mut mesh = common::chiral().into_quadratic().unwrap();
    mesh.hexes.pop();
    mesh.hex_tags = None;
    let error = write_to_with(Vec::new(), Format::Vtu, &mesh, Encoding::Text).unwrap_err().to_string();
    assert!(error.contains("inconsistent"), "{error}");
    let error = mixed().into_quadratic().unwrap_err().to_string();
    assert!(error.contains("faces") && error.contains("--quadratic"), "{error}");
    let nowhere = MeshData { has_coordinates: false, points: Vec::new(), ..common::chiral() };
    assert!(nowhere.into_quadratic().unwrap_err().to_string().contains("coordinates"));
}

#[test]
fn all_kinds_of_cells_and_faces() {
    for (format, encoding) in flavours() {
        let mut mesh = without_what_is_not_held(mixed(), format);
        if !format.holds_cells() {
            mesh = mesh.surface_only();
        }
        if format == Format::Unv {
            mesh.pyramids.clear();
        }
        if format == Format::Json {
            (mesh.tets, mesh.wedges, mesh.pyramids) = Default::default();
        }
        if !format.holds_polygons() {
            let error = write_to_with(Vec::new(), format, &mesh, encoding).unwrap_err().to_string();
            assert!(error.contains("5 sides") && error.contains("face 12"), "{error}");
            mesh.other_faces.pop();
        }
        if format == Format::Json {
            // One list of tags for all faces.
            assert_eq!(round_trip(&mesh, format, encoding).faces().count(), mesh.face_count());
        }
        if format == Format::Medit {
            // Sections by kind: triangles are written, and read, after the quads.
            let n = mesh.quads.len();
            for (i, face) in mesh.other_faces.iter_mut().enumerate() {
                face.position = n + i;
            }
        }
        if format == Format::Inp {
            // Shells come first; quads are faces of hexes here.
            mesh.other_faces.iter_mut().enumerate().for_each(|(i, face)| face.position = i);
        }
        if format == Format::Json {
            mesh.other_faces.iter_mut().for_each(|f| f.tag = 0);
            mesh.quad_tags = None;
        }
        let back = with_any_first_corner(round_trip(&mesh, format, encoding), format);
        assert_same(&back, &with_any_first_corner(mesh, format), &format!("{format} {encoding:?}"));
    }
}

#[test]
fn compressed_files_in_a_directory() {
    let directory = std::env::temp_dir().join(format!("hexfill-io-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    for (format, encoding) in flavours() {
        for packing in ["", ".gz", ".zst", ".GZ"] {
            let path = directory.join(format!("mesh.{}{packing}", format.extensions()[0]));
            let mut mesh = chiral_for(format);
            if format == Format::Nastran {
                mesh.points[7][2] = 1.25; // in 16 characters
            }
            write_path_with(&path, Some(format), &mesh, encoding).unwrap();
            let first = std::fs::read(&path).unwrap();
            let magic: &[u8] = match packing {
                "" => &[],
                ".zst" => &[0x28, 0xb5, 0x2f, 0xfd],
                _ => &[0x1f, 0x8b],
            };
            assert!(first.starts_with(magic), "{path:?}");
            let (back, due) = (read_path(&path, None).unwrap(), with_any_first_corner(mesh.clone(), format));
            assert_same(&with_any_first_corner(back, format), &due, &path.display().to_string());
            // Overwriting gives the same bytes.
            write_path_with(&path, Some(format), &mesh, encoding).unwrap();
            assert_eq!(std::fs::read(&path).unwrap(), first);
        }
    }
    // No temporary files are left behind.
    for entry in std::fs::read_dir(&directory).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(name.starts_with("mesh."), "{name}");
    }
    std::fs::remove_dir_all(&directory).unwrap();
}

#[cfg(unix)]
#[test]
fn links_and_permissions_are_kept() {
    use std::os::unix::fs::PermissionsExt;
    let directory = std::env::temp_dir().join(format!("hexfill-io-unix-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    let mode = |name: &str| std::fs::metadata(directory.join(name)).unwrap().permissions().mode() & 0o777;
    let write = |name: &str| write_path_with(&directory.join(name), None, &chiral_for(Format::Vtk), Encoding::Text);
    // A new file has the permissions of any new file.
    std::fs::write(directory.join("plain"), "").unwrap();
    write("new.vtk").unwrap();
    assert_eq!(mode("new.vtk"), mode("plain"));
    // An old one keeps its own; a link stays a link.
    std::fs::set_permissions(directory.join("new.vtk"), std::fs::Permissions::from_mode(0o640)).unwrap();
    std::os::unix::fs::symlink("new.vtk", directory.join("link.vtk")).unwrap();
    write("link.vtk").unwrap();
    assert!(std::fs::symlink_metadata(directory.join("link.vtk")).unwrap().is_symlink());
    assert_eq!(mode("new.vtk"), 0o640);
    // A device is written to, not replaced.
    write_path_with("/dev/null".as_ref(), Some(Format::Vtk), &chiral_for(Format::Vtk), Encoding::Text).unwrap();
    assert!(!std::fs::metadata("/dev/null").unwrap().is_file());
    std::fs::remove_dir_all(&directory).unwrap();
}

#[test]
fn surfaces_and_meshes_come_out_and_bad_faces_are_named() {
    let mesh = chiral_for(Format::Vtk);
    let mut surface = mesh.surface_only();
    assert_eq!(surface.quad_surface().unwrap().genus(), 0);
    let boundary = |quads: &mut dyn Iterator<Item = [u32; 4]>| {
        let mut quads: Vec<_> = quads.map(|q| common::quad_key(&q)).collect();
        quads.sort_unstable();
        quads
    };
    let of_hexes = mesh.hex_mesh().unwrap().boundary_quads();
    assert_eq!(boundary(&mut of_hexes.iter().map(|q| q.map(|v| v.0))), boundary(&mut surface.quads.iter().copied()));
    surface.quads.remove(7);
    let message = surface.quad_surface().unwrap_err().to_string();
    assert!(message.contains("open"), "{message}");
    let message = mixed().quad_surface().unwrap_err().to_string();
    assert!(message.contains("face 0 (3 sides)") && message.contains("face 12 (5 sides)"), "{message}");
}

#[test]
fn connectivity_without_coordinates() {
    let mut mesh = chiral_for(Format::Json);
    mesh.points.clear();
    mesh.has_coordinates = false;
    assert_eq!(mesh.vertex_count(), 12);
    let back = round_trip(&mesh, Format::Json, Encoding::Text);
    assert_same(&back, &mesh, "json");
    for format in Format::ALL.into_iter().filter(|&f| f != Format::Json) {
        let error = write_to_with(Vec::new(), format, &mesh, Encoding::Text).unwrap_err().to_string();
        assert!(error.contains("coordinates"), "{error}");
    }
}

#[test]
fn empty_meshes_are_written_and_read_or_refused_clearly() {
    for (format, encoding) in flavours() {
        let mut file = Vec::new();
        write_to_with(&mut file, format, &MeshData::default(), encoding).unwrap();
        match read_from(file.as_slice(), format, "empty") {
            Ok(mesh) => assert_eq!(mesh.vertex_count() + mesh.face_count() + mesh.cell_count(), 0, "{format}"),
            Err(e) => assert!(e.to_string().starts_with("empty"), "{e}"),
        }
    }
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -10.0..10.0f64,
        2 => any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite()),
        1 => prop::sample::select(vec![
            0.0, -0.0, 1e300, -1e300, f64::MAX, f64::MIN, f64::MIN_POSITIVE, 5e-324, -5e-324, 2.225_073_858_507_201e-308,
            0.1, 1.0 / 3.0, 1e15, 1e16, 1e-5, 9.999e-6, 123_456_789.123_456_79, f64::EPSILON,
        ]),
    ]
}

prop_compose! {
    fn any_mesh()(points in prop::collection::vec(prop::array::uniform3(coordinate()), 8..30))
        (hexes in prop::collection::vec(prop::sample::subsequence((0..points.len() as u32).collect::<Vec<_>>(), 8).prop_shuffle(), 0..6),
         quads in prop::collection::vec(prop::sample::subsequence((0..points.len() as u32).collect::<Vec<_>>(), 4).prop_shuffle(), 1..9),
         triangles in prop::collection::vec((0..9usize, prop::sample::subsequence((0..points.len() as u32).collect::<Vec<_>>(), 3)), 0..4),
         tags in prop::collection::vec(prop_oneof![-3i64..9, Just(i64::from(i32::MAX)), Just(i64::from(i32::MIN))], 64),
         values in prop::collection::vec(prop_oneof![coordinate(), Just(f64::NAN)], 64),
         points in Just(points))
    -> MeshData {
        let hexes: Vec<[u32; 8]> = hexes.into_iter().map(|h| h.try_into().unwrap()).collect();
        let quads: Vec<[u32; 4]> = quads.into_iter().map(|q| q.try_into().unwrap()).collect();
        let mut positions: Vec<usize> = triangles.iter().map(|t| t.0 % (quads.len() + 1)).collect();
        positions.sort_unstable();
        let other_faces = positions.iter().enumerate().zip(&triangles).map(|((i, &p), (_, vertices))| {
            OtherFace { position: p + i, vertices: vertices.clone(), tag: tags[i] }
        }).collect();
        let some = |n: usize, from: usize| Some(tags[from..from + n].to_vec()).filter(|t| t.iter().any(|&x| x != 0));
        MeshData {
            point_tags: some(points.len(), 3),
            quad_tags: some(quads.len(), 33),
            hex_tags: some(hexes.len(), 50),
            point_data: vec![("a b%\"<&".to_owned(), values[..points.len()].to_vec())],
            // One value at least: an array without any is none.
            quad_data: vec![("q".to_owned(), std::iter::once(0.5).chain(values[9..].iter().copied()).take(quads.len()).collect())],
            hex_data: if hexes.is_empty() { vec![] } else { vec![("q".to_owned(), std::iter::once(-2.5).chain(values[41..].iter().copied()).take(hexes.len()).collect())] },
            points, quads, other_faces, hexes,
            ..MeshData::default()
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_mesh_in_any_format(mesh in any_mesh()) {
        for (format, encoding) in flavours() {
            let mut mesh = without_what_is_not_held(mesh.clone(), format);
            if !format.holds_cells() {
                mesh = mesh.surface_only();
            }
            if format == Format::Medit {
                let n = mesh.quads.len();
                for (i, face) in mesh.other_faces.iter_mut().enumerate() {
                    face.position = n + i;
                }
            }
            if matches!(format, Format::Msh22 | Format::Msh41 | Format::Ovm | Format::Ply) {
                // Quotation marks end a name.
                for (name, _) in &mut mesh.point_data {
                    *name = name.replace('"', "_");
                }
            }
            if format == Format::Ovm {
                // Random hexes are no cells of a complex; faces may coincide. One hex alone is.
                mesh.hexes.truncate(1);
                mesh.hex_tags = mesh.hex_tags.map(|t| t[..1].to_vec()).filter(|t| t[0] != 0);
                mesh.hex_data.iter_mut().for_each(|(_, values)| values.truncate(1));
                mesh.hex_data.retain(|(_, values)| !values.is_empty());
            }
            if format == Format::Inp {
                // A quad on a hex would be a face of it, listed after the others.
                mesh.hexes.clear();
                mesh.hex_tags = None;
            }
            assert_same(&round_trip(&mesh, format, encoding), &mesh, &format!("{format} {encoding:?}"));
        }
    }
}
