//! Other programs read what is written here, and what they write is read here: meshio, PyVista (VTK) and Gmsh, from PyPI,
//! in a virtual environment under the target directory. The work on their side is in `foreign_readers.py` and `foreign_writers.py`.
//!
//! Skipped, with the reason printed, only where the packages cannot be installed; `HEXFILL_FOREIGN=require` makes that a
//! failure, `HEXFILL_FOREIGN=skip` skips. Gmsh needs some X libraries (see the message it gives).

mod common;

use hexfill_io::{Encoding, Format, write_path_with};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// What is installed; pinned, so that a new release cannot break the build.
const PACKAGES: [&str; 4] = ["meshio==5.3.5", "numpy==2.4.6", "pyvista==0.49.1", "gmsh==4.15.2"];

fn run(command: &mut Command) -> Result<Output, String> {
    let output = command.output().map_err(|e| format!("{command:?}: {e}"))?;
    if output.status.success() {
        return Ok(output);
    }
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    Err(format!("{command:?} failed:\n{out}\n{err}"))
}

/// The interpreter of the virtual environment, made on first use.
fn python() -> Result<PathBuf, String> {
    let home = Path::new(env!("CARGO_TARGET_TMPDIR")).join("foreign-venv");
    let python = home.join("bin").join("python");
    let stamp = home.join("installed.txt");
    if std::fs::read_to_string(&stamp).is_ok_and(|s| s == PACKAGES.join("\n")) {
        return Ok(python);
    }
    run(Command::new("python3").arg("-m").arg("venv").arg("--clear").arg(&home))?;
    run(Command::new(&python).args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]).args(PACKAGES))?;
    std::fs::write(&stamp, PACKAGES.join("\n")).map_err(|e| e.to_string())?;
    Ok(python)
}

fn script(python: &Path, name: &str, directory: &Path) -> String {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name);
    match run(Command::new(python).arg("-B").arg(script).arg(directory)) {
        Ok(output) => String::from_utf8_lossy(&output.stdout).into_owned(),
        Err(e) => panic!("{e}"),
    }
}

/// The mesh in all formats, as `NAME.EXTENSION`, and as `expected.json`.
fn write_all(directory: &Path) {
    let mesh = common::chiral();
    write_path_with(&directory.join("expected.json"), None, &mesh, Encoding::Text).unwrap();
    for format in Format::ALL {
        for encoding in [Encoding::Text, Encoding::Binary] {
            if encoding == Encoding::Binary && !format.has_binary() {
                continue;
            }
            let mesh = common::chiral_for(format);
            let binary = if encoding == Encoding::Binary { "-binary" } else { "" };
            let extension = if format == Format::Msh41 { "msh" } else { format.extensions()[0] };
            let path = directory.join(format!("{format}{binary}.{extension}"));
            write_path_with(&path, Some(format), &mesh, encoding).unwrap();
            if format.holds_quadratic() {
                let path = directory.join(format!("quadratic-{format}{binary}.{extension}"));
                write_path_with(&path, Some(format), &mesh.clone().into_quadratic().unwrap(), encoding).unwrap();
            }
            // The surface alone, which is what most files will be.
            let path = directory.join(format!("{format}{binary}-surface.{extension}"));
            write_path_with(&path, Some(format), &mesh.surface_only(), encoding).unwrap();
            // With names; and with tags on some faces only, as a filled surface has them.
            let path = directory.join(format!("named-{format}{binary}.{extension}"));
            write_path_with(&path, Some(format), &common::named_for(format), encoding).unwrap();
            let mut partly = mesh.clone();
            partly.hex_tags = None;
            partly.quad_tags.iter_mut().flatten().filter(|t| **t == 1).for_each(|t| *t = 0);
            let path = directory.join(format!("partly-{format}{binary}.{extension}"));
            write_path_with(&path, Some(format), &partly, encoding).unwrap();
            // With numbers of nodes that neither ascend nor follow each other.
            if matches!(format, Format::Inp | Format::Nastran | Format::Unv | Format::Msh22 | Format::Msh41) {
                let mut numbered = common::chiral_for(format);
                let numbers = (0..12).map(|i| f64::from(7 + 13 * (5 * i % 12))).collect();
                numbered.point_data.push(("node".to_owned(), numbers));
                let path = directory.join(format!("numbered-{format}{binary}.{extension}"));
                write_path_with(&path, Some(format), &numbered, encoding).unwrap();
            }
        }
    }
}

#[test]
fn other_programs_agree() {
    let wish = std::env::var("HEXFILL_FOREIGN").unwrap_or_default();
    if wish == "skip" {
        println!("skipped: HEXFILL_FOREIGN=skip");
        return;
    }
    let python = match python() {
        Ok(python) => python,
        Err(reason) if wish == "require" => panic!("{reason}"),
        Err(reason) => {
            println!("SKIPPED: meshio, PyVista and Gmsh cannot be installed here: {reason}");
            return;
        }
    };
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("foreign");
    let _ = std::fs::remove_dir_all(&directory);
    std::fs::create_dir_all(&directory).unwrap();
    write_all(&directory);
    let report = script(&python, "foreign_readers.py", &directory);
    print!("{report}");
    let checks = report.lines().filter(|l| l.starts_with("ok ")).count();
    assert!(checks >= 40, "only {checks} files were read by other programs");

    let theirs = directory.join("theirs");
    std::fs::create_dir_all(&theirs).unwrap();
    std::fs::copy(directory.join("expected.json"), theirs.join("expected.json")).unwrap();
    let list = script(&python, "foreign_writers.py", &theirs);
    let count = common::compare_list(&theirs, &list);
    println!("{count} files of other programs were read");
    assert!(count >= 25, "{list}");
}

#[test]
fn other_programs_files() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/files");
    let list = std::fs::read_to_string(corpus.join("list.txt")).unwrap();
    let count = common::compare_list(&corpus, &list);
    assert!(count >= 30, "{count} files");
}
