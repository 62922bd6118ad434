//! What every target does: read the bytes; if they are a mesh, it keeps the promises of `MeshData`, and written as
//! VTK (or JSON) it comes back the same.

use hexfill_io::{Format, MeshData, read_from, write_to};

/// Reads `data` as `format` and checks what comes out.
pub fn read(data: &[u8], format: Format) {
    // A packed file unpacks to a thousand times its size, which only tests patience: `packed` does that.
    if data.starts_with(&[0x1f, 0x8b]) || data.starts_with(&[0x28, 0xb5, 0x2f, 0xfd]) {
        return;
    }
    check(data, format);
}

/// The same without the exception for packed data.
pub fn check(data: &[u8], format: Format) {
    let mesh = match read_from(data, format, "fuzz") {
        Ok(mesh) => mesh,
        Err(e) => {
            assert!(e.to_string().starts_with("fuzz"), "the file is named: {e}");
            return;
        }
    };
    let via = if mesh.has_coordinates { Format::Vtk } else { Format::Json };
    mesh.check_for(via).expect("what is read can be written");
    let mut file = Vec::new();
    write_to(&mut file, via, &mesh).expect("writing to memory works");
    let again = read_from(file.as_slice(), via, "again").expect("what is written can be read");
    assert_eq!(connectivity(&again), connectivity(&mesh));
    let bits = |m: &MeshData| m.points.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&again), bits(&mesh));
}

type Connectivity<'a> = (Vec<&'a [u32]>, &'a [[u32; 8]], &'a [[u32; 4]], &'a [[u32; 6]], &'a [[u32; 5]]);

fn connectivity(m: &MeshData) -> Connectivity<'_> {
    (m.faces().collect(), &m.hexes, &m.tets, &m.wedges, &m.pyramids)
}
