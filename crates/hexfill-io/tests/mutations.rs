//! A small deterministic fuzzer: valid files of every format, a few bytes flipped, deleted, doubled or moved.
//! The readers may say anything but must come back.

mod common;

use hexfill_io::{Encoding, Format, read_from, write_to_with};

/// splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

const WORDS: [&[u8]; 14] = [
    b"-1",
    b"0",
    b"4294967295",
    b"4294967296",
    b"9223372036854775807",
    b"-9223372036854775808",
    b"1e308",
    b"nan",
    b"\n",
    b" ",
    b"\0",
    b"\\\n",
    b"18446744073709551615",
    b"%",
];

fn mutate(file: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        if file.is_empty() {
            return;
        }
        let at = random.below(file.len());
        let length = random.below(12).min(file.len() - at);
        match random.below(8) {
            0 => file[at] ^= 1 << random.below(8),
            1 => file[at] = random.next() as u8,
            2 => drop(file.drain(at..at + length)),
            3 => {
                let piece = file[at..at + length].to_vec();
                let to = random.below(file.len());
                file.splice(to..to, piece);
            }
            4 => {
                // A number becomes another one.
                let start = (at..file.len()).find(|&i| file[i].is_ascii_digit()).unwrap_or(at);
                let end = (start..file.len()).find(|&i| !file[i].is_ascii_digit()).unwrap_or(file.len());
                file.splice(start..end, WORDS[random.below(WORDS.len())].iter().copied());
            }
            5 => file.truncate(at),
            6 => {
                // A line moves.
                let end = (at..file.len()).find(|&i| file[i] == b'\n').map_or(file.len(), |i| i + 1);
                let line: Vec<u8> = file.drain(at..end).collect();
                let to = random.below(file.len() + 1);
                file.splice(to..to, line);
            }
            _ => {
                let word = WORDS[random.below(WORDS.len())];
                file.splice(at..at, word.iter().copied());
            }
        }
    }
}

#[test]
fn no_mutation_makes_a_reader_panic() {
    let rounds = if std::env::var_os("HEXFILL_SLOW").is_some() { 200_000 } else { 3_000 };
    let mut read = 0u64;
    for (k, format) in Format::ALL.into_iter().enumerate() {
        for encoding in [Encoding::Text, Encoding::Binary] {
            if encoding == Encoding::Binary && !format.has_binary() {
                continue;
            }
            let mut file = Vec::new();
            write_to_with(&mut file, format, &common::chiral_for(format), encoding).unwrap();
            let mut random = Random(k as u64 + 1);
            for _ in 0..rounds {
                let mut changed = file.clone();
                mutate(&mut changed, &mut random);
                if let Ok(mesh) = read_from(changed.as_slice(), format, "mutant") {
                    read += 1;
                    // What is read keeps the promises of `MeshData`: it can be written.
                    mesh.check_for(if mesh.has_coordinates { Format::Vtk } else { Format::Json })
                        .unwrap_or_else(|e| panic!("{format}: {e}\n{}", String::from_utf8_lossy(&changed)));
                }
            }
        }
    }
    assert!(read > 0, "some mutants are still meshes");
}

#[test]
fn every_cut_is_survived() {
    for format in Format::ALL {
        for encoding in [Encoding::Text, Encoding::Binary] {
            if encoding == Encoding::Binary && !format.has_binary() {
                continue;
            }
            let mut file = Vec::new();
            write_to_with(&mut file, format, &common::chiral_for(format), encoding).unwrap();
            for cut in 0..file.len() {
                let _ = read_from(&file[..cut], format, "cut");
            }
        }
    }
}
