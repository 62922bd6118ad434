//! `hexfill doctor SURFACE [--fix -o FIXED]`: everything about a surface before the work, and what mends it.

use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use anyhow::bail;
use hexfill::io::{Format, MeshData};
use hexfill::{CureOptions, Diagnosis, Problem, cure, doctor};
use serde::Serialize;

/// Flags of `doctor`.
#[derive(clap::Args)]
pub(crate) struct DoctorArgs {
    /// The surface: a file, `-`, a catalogue name or a signature.
    surface: String,
    #[command(flatten)]
    reading: files::InputArgs,
    /// Mend what has one smallest remedy: seams that only rounding keeps open are welded, faces that are flat or come twice go, triangles are merged in pairs, an odd number of quads becomes
    /// even, quads are turned to face outward.
    #[arg(long, requires = "output")]
    fix: bool,
    /// Cut every face of n sides into n quads: always an even number, whatever it was.
    #[arg(long, requires = "fix")]
    refine: bool,
    /// Where the mended surface goes.
    #[arg(short, long, value_name = "FIXED", requires = "fix")]
    output: Option<String>,
    /// Format of the mended surface.
    #[arg(long, value_name = "FORMAT", value_parser = files::parse_format)]
    to: Option<Format>,
}

#[derive(Serialize)]
struct Output<'a> {
    surface: &'a str,
    #[serde(flatten)]
    diagnosis: &'a Diagnosis,
    /// What was mended; absent without --fix.
    mended: Option<Mended>,
    exit_code: u8,
}

#[derive(Serialize)]
struct Mended {
    file: String,
    done: Vec<String>,
    /// The surface as it is then.
    after: Diagnosis,
}

/// Examines, mends if asked; exit code 1 if the surface (the mended one, with --fix) cannot be filled.
pub(crate) fn run(args: &DoctorArgs, console: &Console) -> anyhow::Result<Exit> {
    if let Some(output) = &args.output {
        files::check_output(output, args.to)?;
        files::check_distinct(&[&args.surface, output])?;
        if console.json && output == "-" {
            bail!("--json and -o - both write to stdout; give a file to one of them");
        }
    }
    let data = read(args)?;
    let before = doctor(&args.surface, &data);
    if !console.json {
        print(&args.surface, &before, console)?;
    }
    let mut can_be_filled = before.can_be_filled;
    let mut mended = None;
    if let Some(output) = &args.output {
        let cured = cure(&args.surface, &data, &CureOptions::default().with_refine(args.refine));
        let after = doctor(output, &cured.data);
        files::write_data(output, args.to, &cured.data, console)?;
        can_be_filled = after.can_be_filled;
        if !console.json {
            for done in &cured.done {
                console.say(format!("mended: {done}"));
            }
            if cured.done.is_empty() {
                let left =
                    if before.can_be_filled { "it can be filled as it was read" } else { "what was found needs you" };
                console.say(format!("mended: nothing; {left}"));
            }
            console.say(format!("written: {output}"));
            print(output, &after, console)?;
        }
        mended = Some(Mended { file: output.clone(), done: cured.done, after });
    }
    let exit = if can_be_filled { Exit::Done } else { Exit::No };
    if console.json {
        console.print_json(&Output { surface: &args.surface, diagnosis: &before, mended, exit_code: exit as u8 })?;
    }
    Ok(exit)
}

fn read(args: &DoctorArgs) -> anyhow::Result<MeshData> {
    if hexfill::is_named(&args.surface) {
        return Ok(Problem::load(&args.surface, None)?.data());
    }
    let data = files::read_data(&args.surface, &args.reading)?;
    if data.face_count() == 0 && !data.hexes.is_empty() {
        bail!("{} is a hex mesh, not a surface; use `hexfill check`", args.surface);
    }
    Ok(data)
}

fn print(name: &str, diagnosis: &Diagnosis, console: &Console) -> anyhow::Result<()> {
    let found = &diagnosis.findings;
    let faces: Vec<String> = found
        .faces
        .iter()
        .map(|(sides, n)| match (sides, n) {
            (3, 1) => "1 triangle".to_owned(),
            (3, n) => format!("{n} triangles"),
            (4, 1) => "1 quad".to_owned(),
            (4, n) => format!("{n} quads"),
            (sides, n) => format!("{n} of {sides} sides"),
        })
        .collect();
    console.print(format!(
        "{name}: {} points; {}",
        found.points,
        if faces.is_empty() { "no faces".to_owned() } else { faces.join(", ") }
    ))?;
    for note in &diagnosis.notes {
        console.print(format!("note: {note}"))?;
    }
    for finding in &found.findings {
        console.print(finding.to_string())?;
    }
    if let Some(what) = &found.not_examined {
        console.print(format!("not examined: {what}"))?;
    }
    if let Some(limits) = &diagnosis.limits {
        limits.lines().into_iter().try_for_each(|line| console.print(line))?;
    }
    if let Some(existence) = &diagnosis.existence {
        console.print(existence.to_string())?;
    }
    console.print(if diagnosis.can_be_filled {
        "`hexfill fill` takes it as it is"
    } else {
        "`hexfill fill` cannot take it as it is"
    })
}
