//! Chunks and ledgers: partition, repetition, torn and changed files, and a process killed in the middle.

use hexfill_enumerate::{
    Chunk, EnumerateError, Header, Ledger, LevelOptions, Params, Plan, Rule, Selection, Tally, Wanted, chunks_of_part,
    ledger_path, merge, read_ledgers, run_checkpointed, run_whole,
};
use hexfill_mesh::Context;
use std::path::Path;

const WHOLE: Chunk = Chunk { index: 0, of: 1 };

fn plan(cubes: usize, rule: Rule) -> Plan {
    Plan::prepare(&Params::new(cubes, rule), &LevelOptions::default(), &Context::default()).unwrap()
}

fn header(plan: &Plan, chunks: usize) -> Header {
    Header::new(plan.params(), String::new(), false, Vec::new(), chunks)
}

fn run(plan: &Plan, folder: &Path, part: Chunk, header: &Header) -> Result<Tally, EnumerateError> {
    run_checkpointed(plan, folder, part, header, 2, Wanted::default(), &Context::default()).map(|r| r.tally)
}

fn whole(plan: &Plan) -> Tally {
    run_whole(plan, 2, Wanted::default(), &Context::default()).unwrap().0
}

#[test]
fn chunks_of_any_number_partition_the_whole() {
    for rule in [Rule::Strict, Rule::Weill] {
        let plan = plan(6, rule);
        let expected = whole(&plan);
        for of in [1, 2, 3, 7, 500] {
            let mut sum = Tally::default();
            for index in 0..of {
                sum.merge(&plan.run(Chunk { index, of }, Wanted::default(), &Context::default()).unwrap().tally);
            }
            assert_eq!(sum, expected, "{rule} in {of} chunks");
        }
        assert!(plan.run(Chunk { index: 3, of: 3 }, Wanted::default(), &Context::default()).is_err());
    }
}

#[test]
fn job_arrays_merge_and_repetition_changes_nothing() {
    let plan = plan(5, Rule::Strict);
    let header = header(&plan, 12);
    let folder = tempfile::tempdir().unwrap();
    for index in [2, 0, 1] {
        run(&plan, folder.path(), Chunk { index, of: 3 }, &header).unwrap();
    }
    let merged = merge(folder.path()).unwrap();
    assert_eq!(merged.tally(), whole(&plan));
    assert!(merged.inconsistencies().is_empty());
    let before = std::fs::read(ledger_path(folder.path(), Chunk { index: 1, of: 3 })).unwrap();
    run(&plan, folder.path(), Chunk { index: 1, of: 3 }, &header).unwrap();
    assert_eq!(before, std::fs::read(ledger_path(folder.path(), Chunk { index: 1, of: 3 })).unwrap());
    assert!(chunks_of_part(Chunk { index: 0, of: 5 }, 12).is_err());
}

#[test]
fn gaps_overlaps_and_mixed_parameters_are_refused_by_name() {
    let strict = plan(5, Rule::Strict);
    let folder = tempfile::tempdir().unwrap();
    run(&strict, folder.path(), Chunk { index: 0, of: 2 }, &header(&strict, 4)).unwrap();
    match merge(folder.path()) {
        Err(EnumerateError::Incomplete { why }) => assert!(why.contains("2 of 4") && why.contains("1, 3"), "{why}"),
        other => panic!("{other:?}"),
    }
    // Another rule, or another number of chunks, in the same ledger.
    let weill = plan(5, Rule::Weill);
    match run(&weill, folder.path(), Chunk { index: 0, of: 2 }, &header(&weill, 4)) {
        Err(EnumerateError::OtherParameters { differences, .. }) => {
            assert!(differences.contains("rule is strict, not weill"), "{differences}");
        }
        other => panic!("{other:?}"),
    }
    assert!(matches!(
        run(&strict, folder.path(), Chunk { index: 0, of: 2 }, &header(&strict, 8)),
        Err(EnumerateError::OtherParameters { .. })
    ));
    // Another rule in another ledger of the folder.
    run(&weill, folder.path(), Chunk { index: 1, of: 2 }, &header(&weill, 4)).unwrap();
    assert!(matches!(merge(folder.path()), Err(EnumerateError::OtherParameters { .. })));
    // An overlap.
    let folder = tempfile::tempdir().unwrap();
    run(&strict, folder.path(), WHOLE, &header(&strict, 4)).unwrap();
    run(&strict, folder.path(), Chunk { index: 1, of: 2 }, &header(&strict, 4)).unwrap();
    match merge(folder.path()) {
        Err(EnumerateError::Incomplete { why }) => assert!(why.contains("chunk 1") && why.contains("chunk 3"), "{why}"),
        other => panic!("{other:?}"),
    }
    assert!(matches!(merge(tempfile::tempdir().unwrap().path()), Err(EnumerateError::Incomplete { .. })));
}

#[test]
fn every_flipped_byte_is_noticed_and_a_torn_end_is_dropped() {
    let plan = plan(3, Rule::Strict);
    let header = header(&plan, 2);
    let folder = tempfile::tempdir().unwrap();
    let expected = run(&plan, folder.path(), WHOLE, &header).unwrap();
    let path = ledger_path(folder.path(), WHOLE);
    let good = std::fs::read(&path).unwrap();
    for at in 0..good.len() {
        let mut bad = good.clone();
        bad[at] ^= 1;
        std::fs::write(&path, &bad).unwrap();
        let last_end = at == good.len() - 1;
        match read_ledgers(&path) {
            // The very last byte is the end of the last line: without it the line is torn, its chunk not done.
            Ok(merged) => assert!(last_end && merged.missing().count() == 1, "byte {at}"),
            Err(EnumerateError::BadLedger { .. }) => {}
            other => panic!("byte {at}: {other:?}"),
        }
    }
    // Each opening syncs the disk: not every length, but all near the ends of lines.
    let near = |end: usize| good[end.saturating_sub(2)..(end + 2).min(good.len())].contains(&b'\n');
    for end in (0..good.len()).filter(|&end| end % 61 == 0 || near(end)) {
        std::fs::write(&path, &good[..end]).unwrap();
        let again = Ledger::open(folder.path(), WHOLE, &header).unwrap();
        assert_eq!(again.records().len(), good[..end].iter().filter(|&&b| b == b'\n').count().saturating_sub(1));
        drop(again);
        if end % 2 == 0 {
            assert_eq!(run(&plan, folder.path(), WHOLE, &header).unwrap(), expected);
        }
    }
}

#[test]
fn one_process_at_a_time_writes_a_ledger() {
    let plan = plan(4, Rule::Strict);
    let header = header(&plan, 3);
    let folder = tempfile::tempdir().unwrap();
    let first = Ledger::open(folder.path(), WHOLE, &header).unwrap();
    assert!(matches!(Ledger::open(folder.path(), WHOLE, &header), Err(EnumerateError::Io { .. })));
    drop(first);
    assert!(Ledger::open(folder.path(), WHOLE, &header).is_ok());
}

#[test]
fn listed_objects_survive_and_merge() {
    let plan = plan(5, Rule::Strict);
    let folder = tempfile::tempdir().unwrap();
    let selection = Selection { balls: true, ..Selection::default() };
    let header = Header::new(plan.params(), selection.text(), true, Vec::new(), 6);
    let wanted = Wanted { selection: Some(&selection), list: true, targets: &[] };
    let done = run_checkpointed(&plan, folder.path(), WHOLE, &header, 2, wanted, &Context::default()).unwrap();
    assert_eq!((done.tally.selected, done.tally.balls), (60, 60));
    let mut codes = Vec::new();
    let merged = merge(folder.path()).unwrap();
    merged
        .for_each_listed(&mut |code| {
            codes.push(code);
            Ok(())
        })
        .unwrap();
    codes.sort_unstable();
    codes.dedup();
    assert_eq!(codes.len(), 60);
    std::fs::write(folder.path().join("objects-0-of-6.txt"), "01\n01\n").unwrap();
    assert!(merged.for_each_listed(&mut |_| Ok(())).is_err());
}

/// Not a test of its own: the process that the next test kills.
#[test]
fn worker_to_be_killed() {
    let Some(folder) = std::env::var_os("HEXFILL_TEST_LEDGER") else { return };
    let plan = plan(7, Rule::Strict);
    run(&plan, Path::new(&folder), WHOLE, &header(&plan, 24)).unwrap();
}

#[test]
fn a_run_killed_in_the_middle_goes_on_and_gives_the_same_totals() {
    let folder = tempfile::tempdir().unwrap();
    let me = std::env::current_exe().unwrap();
    let path = ledger_path(folder.path(), WHOLE);
    let lines = || std::fs::read(&path).map_or(0, |b| b.iter().filter(|&&b| b == b'\n').count());
    let mut last = 0;
    let mut kills = 0;
    // Killed (SIGKILL) twice after some progress, then left to finish.
    loop {
        let mut child = std::process::Command::new(&me)
            .args(["--exact", "worker_to_be_killed", "--test-threads", "1"])
            .env("HEXFILL_TEST_LEDGER", folder.path())
            .stdout(std::process::Stdio::null())
            .spawn()
            .unwrap();
        if kills == 2 {
            assert!(child.wait().unwrap().success());
            break;
        }
        while lines() < last + 3 && child.try_wait().unwrap().is_none() {
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(lines() >= last, "finished chunks are never lost");
        last = lines();
        kills += 1;
    }
    let merged = merge(folder.path()).unwrap();
    assert_eq!(merged.records.len(), 24);
    assert_eq!(lines(), 25, "one line a chunk and the header: no chunk was done twice");
    let tally = merged.tally();
    assert_eq!((tally.classes, tally.balls, tally.mass_balances()), (112_650, 3987, true));
    assert_eq!(tally, whole(&plan(7, Rule::Strict)));
}
