//! Runs the program under `mpirun` with 1, 2 and 4 ranks; skipped, saying so, where there is no `mpirun`.

use std::process::{Command, Output};

fn mpirun(ranks: usize, args: &[&str]) -> Option<Output> {
    let mut command = Command::new("mpirun");
    // Open MPI refuses to run as root and on few cores without these; MPICH ignores them.
    command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command.env("OMPI_MCA_rmaps_base_oversubscribe", "1");
    command.args(["-n", &ranks.to_string(), env!("CARGO_BIN_EXE_hexfill-mpi")]).args(args);
    match command.output() {
        Ok(output) => Some(output),
        Err(error) => {
            eprintln!("skipped: mpirun cannot be run: {error}");
            None
        }
    }
}

fn json(output: &Output) -> serde_json::Value {
    let text = String::from_utf8_lossy(&output.stdout);
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text} {}", String::from_utf8_lossy(&output.stderr)))
}

#[test]
fn totals_do_not_depend_on_the_number_of_ranks() {
    for rule in ["strict", "weill"] {
        let mut first = None;
        for ranks in [1, 2, 4] {
            let Some(output) = mpirun(ranks, &["6", "--rule", rule, "--chunks", "40", "--find", "6x[4,4]"]) else {
                return;
            };
            assert!(output.status.success());
            let report = json(&output);
            assert_eq!(report["counts"]["classes"], if rule == "strict" { 4026 } else { 9500 });
            assert_eq!(*first.get_or_insert_with(|| report.clone()), report, "{ranks} ranks");
        }
    }
}

#[test]
fn a_worker_that_reports_an_error_is_survived() {
    // On a busy machine the other worker may have done everything before this one asks: then nothing failed, and the run
    // shows nothing.
    let has_failed = (0..20).any(|_| {
        let Some(output) = mpirun(3, &["6", "--chunks", "40", "--fail-rank", "2"]) else { return true };
        assert!(output.status.success());
        let report = json(&output);
        assert_eq!((&report["counts"]["classes"], &report["undone"]), (&4026.into(), &0.into()));
        let failures = report["failures"].as_array().map_or(0, Vec::len);
        assert!(failures <= 1, "{report}");
        failures == 1
    });
    assert!(has_failed, "the worker never got a chunk");
    // With no other worker the chunks stay undone, and the exit code says so.
    let Some(output) = mpirun(2, &["5", "--chunks", "10", "--fail-rank", "1"]) else { return };
    assert!(!output.status.success());
    assert_eq!(json(&output)["undone"], 10);
}

#[test]
fn the_ledger_is_shared_with_the_other_drivers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_str().unwrap();
    let args = ["6", "--chunks", "40", "--checkpoint", path];
    let Some(output) = mpirun(2, &args) else { return };
    let first = json(&output);
    let merged = hexfill_enumerate::merge(folder.path()).unwrap();
    assert_eq!((merged.records.len(), merged.tally().classes), (40, 4026));
    assert!(merged.inconsistencies().is_empty());
    let Some(again) = mpirun(3, &args) else { return };
    assert_eq!(json(&again), first);
    let other = ["6", "--chunks", "40", "--checkpoint", path, "--rule", "weill"];
    let Some(refused) = mpirun(3, &other) else { return };
    assert!(!refused.status.success());
    assert!(String::from_utf8_lossy(&refused.stderr).contains("rule is strict, not weill"));
}

/// The signature of two cubes in a row.
fn two_cubes() -> String {
    let hexes = [[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]];
    let row = hexfill_mesh::HexMesh::try_new(12, &hexes).unwrap();
    let quads: Vec<[u32; 4]> = row.boundary_quads().into_iter().map(|q| q.map(|v| v.0)).collect();
    hexfill_mesh::surface_signature(&hexfill_mesh::QuadSurface::try_new(12, &quads).unwrap())
}

#[test]
fn a_search_does_not_depend_on_the_number_of_ranks_and_shares_its_ledger() {
    let surface = two_cubes();
    let args = ["search", surface.as_str(), "--max-hexes", "9", "--chunks", "40"];
    let Some(alone) = mpirun(1, &args) else { return };
    let first = json(&alone);
    assert!(alone.status.success());
    assert_eq!((&first["exhausted"], &first["undone"]), (&true.into(), &0.into()), "{first}");
    let problem = hexfill_prove::Problem::new(&hexfill_mesh::parse_surface_signature(&surface).unwrap(), 9).unwrap();
    let plan = hexfill_prove::Plan::prepare(problem, &hexfill_mesh::Context::default()).unwrap();
    let whole = hexfill_prove::search_whole(&plan, 1, &hexfill_mesh::Context::default()).unwrap();
    assert_eq!(first["tree_sum"], format!("{:032x}", whole.tree_sum));
    assert_eq!(first["hash_sum"], format!("{:032x}", whole.hash_sum()));
    assert_eq!(first["meshes"].as_array().map(Vec::len), Some(whole.meshes.len()));
    let folder = tempfile::tempdir().unwrap();
    let with_ledger = [&args[..], &["--checkpoint", folder.path().to_str().unwrap()]].concat();
    for ranks in [2, 4] {
        let output = mpirun(ranks, &with_ledger).expect("it ran before");
        assert_eq!(json(&output), first, "{ranks} ranks");
    }
    let merged = hexfill_prove::merge(&plan, folder.path()).unwrap();
    assert_eq!((merged.done, merged.outcome.tree_sum), (40, whole.tree_sum));
    let other = [&with_ledger[..2], &["--max-hexes", "8"], &with_ledger[4..]].concat();
    let refused = mpirun(3, &other).expect("it ran before");
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("most hexes is 9, not 8"));
}

#[test]
fn a_search_whose_only_worker_fails_proves_nothing() {
    let surface = two_cubes();
    let args = ["search", surface.as_str(), "--max-hexes", "5", "--chunks", "10", "--fail-rank", "1"];
    let Some(output) = mpirun(2, &args) else { return };
    assert!(!output.status.success());
    let report = json(&output);
    assert_eq!((&report["undone"], &report["exhausted"]), (&10.into(), &false.into()));
}
