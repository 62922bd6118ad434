//! Small files that unpack to huge ones, and files whose parts multiply: an error, never more memory than the stated limit, never an
//! abort. (Counts that nothing stands behind are in `malformed.rs`.)

mod common;

use base64::Engine;
use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use hexfill_io::{Encoding, Format, MeshData, read_from, write_to_with};
use std::io::Write;

/// 300 MiB of `filler` in one member of a gzip file.
fn long(filler: &[u8]) -> Vec<u8> {
    let mut packer = GzEncoder::new(Vec::new(), Compression::fast());
    let block = filler.repeat((1 << 20) / filler.len() + 1);
    (0..300).for_each(|_| packer.write_all(&block).unwrap());
    packer.finish().unwrap()
}

/// A member with `head`, then one that is long.
fn gzip_bomb(head: &[u8], long: &[u8]) -> Vec<u8> {
    let mut packer = GzEncoder::new(Vec::new(), Compression::fast());
    packer.write_all(head).unwrap();
    let mut bomb = packer.finish().unwrap();
    bomb.extend(long);
    bomb
}

fn refused(format: Format, bomb: &[u8]) -> String {
    match read_from(bomb, format, "bomb") {
        Ok(mesh) => panic!("{format}: {} points were read", mesh.points.len()),
        Err(error) => error.to_string(),
    }
}

#[test]
fn every_reader_stops_at_what_is_unpacked() {
    let fillers = [long(b"0 "), long(b"\n")];
    for format in Format::ALL {
        for encoding in [Encoding::Text, Encoding::Binary] {
            if encoding == Encoding::Binary && !format.has_binary() {
                continue;
            }
            let mut file = Vec::new();
            write_to_with(&mut file, format, &common::chiral_for(format), encoding).unwrap();
            // Cut in the middle, so that readers ask for more: a line without an end, or many of them.
            let filler = &fillers[usize::from(encoding == Encoding::Text && format.holds_cells())];
            refused(format, &gzip_bomb(&file[..file.len() / 2], filler));
        }
    }
}

#[test]
fn what_could_be_a_mesh_stops_at_the_limit() {
    let obj = gzip_bomb(b"v 0 0 0\n", &long(b"f 1 1 1 1\n"));
    assert!(refused(Format::Obj, &obj).contains("the limit (256 MiB"));
    let off = gzip_bomb(b"OFF\n1 4000000000 0\n0 0 0\n", &long(b"3 0 0 0\n"));
    assert!(refused(Format::Off, &off).contains("the limit (256 MiB"));
}

/// A VTU whose points are one zlib block of 300 MiB of zeros, appended or in place.
fn vtu_bomb(arrays: usize, mebibytes: u64) -> Vec<u8> {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
    let zeros = vec![0; 1 << 20];
    (0..mebibytes).for_each(|_| packer.write_all(&zeros).unwrap());
    let packed = packer.finish().unwrap();
    let mut header = Vec::new();
    for number in [1, mebibytes << 20, 0, packed.len() as u64] {
        header.extend(number.to_le_bytes());
    }
    let text = |bytes: &[u8]| base64::engine::general_purpose::STANDARD.encode(bytes);
    let n = (mebibytes << 20) / 24;
    let array = "<DataArray type=\"UInt8\" Name=\"a\" format=\"appended\" offset=\"0\"/>".repeat(arrays);
    format!(
        "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\
         <UnstructuredGrid><Piece NumberOfPoints=\"{n}\" NumberOfCells=\"0\"><Points>\
         <DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points><PointData>{array}</PointData>\
         </Piece></UnstructuredGrid><AppendedData encoding=\"base64\">_{}{}</AppendedData></VTKFile>",
        text(&header),
        text(&packed)
    )
    .into_bytes()
}

#[test]
fn compressed_blocks_of_vtu_stop_at_the_limit() {
    assert!(refused(Format::Vtu, &vtu_bomb(0, 300)).contains("memory limit"));
    // Many arrays that are the same bytes.
    assert!(refused(Format::Vtu, &vtu_bomb(300, 3)).contains("memory limit"));
    let small = vtu_bomb(2, 3);
    assert_eq!(read_from(small.as_slice(), Format::Vtu, "small").unwrap().points.len(), (3 << 20) / 24);
    // A claim of 2^60 bytes in a block.
    let mut text = String::from_utf8(vtu_bomb(0, 3)).unwrap();
    let at = text.find('_').unwrap_or(0);
    let claim: Vec<u8> = [1u64, 1 << 60, 0, 10].iter().flat_map(|x| x.to_le_bytes()).collect();
    text.truncate(text.rfind("base64\">_").unwrap_or(at) + 9);
    text += &base64::engine::general_purpose::STANDARD.encode(claim);
    text += "AAAAAAAAAAAAAAAA</AppendedData></VTKFile>";
    assert!(refused(Format::Vtu, text.as_bytes()).contains("memory limit"));
}

#[test]
fn sets_of_sets_do_not_multiply() {
    // One node in 100,000 sets: every set makes a new combination of all before it.
    let mut inp = String::from("*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=S4\n1, 1, 1, 1, 1\n");
    for i in 0..100_000 {
        inp += &format!("*NSET, NSET=n{i}\n1\n*ELSET, ELSET=e{i}\n1\n");
    }
    let read: MeshData = read_from(inp.as_bytes(), Format::Inp, "sets").unwrap();
    assert!(read.notes.iter().any(|n| n.contains("too many groups")), "{:?}", read.notes);
    assert!(read.tag_names.len() <= 2 * 64, "{}", read.tag_names.len());
}

#[test]
fn bits_and_components_are_no_bombs() {
    let vtk = "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 0 float\n\nPOLYGONS 0 0\n\nPOINT_DATA 4000000000\nSCALARS a bit 4\nLOOKUP_TABLE default\n";
    assert!(refused(Format::Vtk, vtk.as_bytes()).contains("bits"));
    let msh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n0\n$EndElements\n$NodeData\n1\n\"a\"\n1\n0\n3\n0\n4000000000\n4000000000\n1 0\n";
    assert!(!refused(Format::Msh22, msh.as_bytes()).is_empty());
}
