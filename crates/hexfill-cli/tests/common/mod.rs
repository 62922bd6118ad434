//! The real binary, run in a folder.
#![allow(dead_code)]

use assert_cmd::Command;
use std::path::Path;

/// Exit code, stdout and stderr.
pub(crate) fn hexfill(dir: &Path, args: &[&str]) -> (i32, String, String) {
    let out = Command::cargo_bin("hexfill").unwrap().current_dir(dir).args(args).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (out.status.code().expect("not killed"), text(out.stdout), text(out.stderr))
}

pub(crate) fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}
