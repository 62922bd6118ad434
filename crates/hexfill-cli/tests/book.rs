//! The commands of the book are run, page by page, and print what the page shows.
//!
//! In a block marked `console`, a line `$ hexfill ...` is a command; `? N` after it is its exit code (0 if absent); the other lines
//! must be what it prints on stdout and stderr together: `[..]` stands for anything in a line, a line `...` for any lines. A
//! command without lines after it may print what it likes. Lines of progress are passed over. Commands that are not to be run here stand in blocks marked `sh`.

use assert_cmd::Command;
use std::path::Path;

struct Step {
    command: String,
    code: i32,
    expected: Vec<String>,
}

fn steps(page: &str) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        if line.starts_with("```") {
            inside = line.trim_end() == "```console";
        } else if inside && let Some(command) = line.strip_prefix("$ ") {
            // Two spaces and a # begin a remark.
            let command = command.split_once("  #").map_or(command, |(command, _)| command).trim_end();
            steps.push(Step { command: command.to_owned(), code: 0, expected: Vec::new() });
        } else if inside && let Some(step) = steps.last_mut() {
            match line.strip_prefix("? ") {
                Some(code) => step.code = code.trim().parse().unwrap(),
                None => step.expected.push(line.to_owned()),
            }
        }
    }
    steps
}

/// Whether `line` is `pattern` with `[..]` standing for anything.
fn line_matches(pattern: &str, line: &str) -> bool {
    let Some((head, tail)) = pattern.split_once("[..]") else { return pattern == line };
    line.strip_prefix(head)
        .is_some_and(|rest| (0..=rest.len()).any(|i| rest.is_char_boundary(i) && line_matches(tail, &rest[i..])))
}

fn matches(patterns: &[String], lines: &[&str]) -> bool {
    match patterns.split_first() {
        None => lines.is_empty(),
        Some((dots, rest)) if dots == "..." => (0..=lines.len()).any(|i| matches(rest, &lines[i..])),
        Some((pattern, rest)) => {
            lines.split_first().is_some_and(|(line, more)| line_matches(pattern, line) && matches(rest, more))
        }
    }
}

/// Whether a line tells of progress, `[   6.5s] pillows (8 %, about 70 s left of it): ...`: on a busy machine any command may take the five seconds
/// after which such lines come.
fn is_progress(line: &str) -> bool {
    let seconds =
        line.strip_prefix('[').and_then(|rest| rest.split_once("s] ")).map(|(seconds, _)| seconds.trim_start());
    seconds.is_some_and(|s| s.contains('.') && s.parse::<f64>().is_ok())
}

fn run_page(path: &Path) -> usize {
    let dir = tempfile::tempdir().unwrap();
    // The pages use files of the repository's folder `corpus` as if they stood beside it.
    #[cfg(unix)]
    std::os::unix::fs::symlink(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus"), dir.path().join("corpus"))
        .unwrap();
    let steps = steps(&std::fs::read_to_string(path).unwrap());
    for step in &steps {
        let words: Vec<&str> = step.command.split_whitespace().collect();
        assert_eq!(words[0], "hexfill", "{}: `{}`", path.display(), step.command);
        let out = Command::cargo_bin("hexfill").unwrap().current_dir(&dir).args(&words[1..]).output().unwrap();
        let text = format!("{}{}", String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
        let place = format!("{}: `{}` printed\n{text}", path.display(), step.command);
        assert_eq!(out.status.code(), Some(step.code), "{place}");
        let lines: Vec<&str> = text.lines().map(str::trim_end).filter(|line| !is_progress(line)).collect();
        let expected: Vec<String> = step.expected.iter().map(|l| l.trim_end().to_owned()).collect();
        assert!(expected.is_empty() || matches(&expected, &lines), "{place}\nthe page shows\n{}", expected.join("\n"));
    }
    steps.len()
}

#[test]
fn every_command_of_the_book_does_what_the_page_shows() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src");
    let summary = std::fs::read_to_string(folder.join("SUMMARY.md")).unwrap();
    let mut pages: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path()).collect();
    pages.sort();
    let mut run = 0;
    for page in pages.iter().filter(|p| p.extension().is_some_and(|e| e == "md")) {
        let name = page.file_name().unwrap().to_str().unwrap();
        if name == "SUMMARY.md" {
            continue;
        }
        assert!(summary.contains(&format!("({name})")), "{name} is not in SUMMARY.md");
        run += run_page(page);
    }
    assert!(run >= 15, "only {run} commands were found");
}

#[test]
fn the_matcher_tells_lines_apart() {
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    assert!(matches(&lines("a[..]c\n...\nz"), &["abc", "x", "y", "z"]));
    assert!(!matches(&lines("a[..]c\nz"), &["abc", "x", "z"]));
    assert!(!matches(&lines("abc"), &[]));
    assert!(is_progress("[   6.5s] pillows (8 %, about 70 s left of it): 43 hexes, 1 of them bad"));
    assert!(["[6s] x", "6.5 s", "[..] s", "[a.bs] x", "  [1.0s] x"].iter().all(|line| !is_progress(line)));
}
