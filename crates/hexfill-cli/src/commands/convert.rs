//! `hexfill convert IN -o OUT`.

use crate::console::{self, Console};
use crate::exit::Exit;
use crate::files;

/// Flags of `convert`.
#[derive(clap::Args)]
pub(crate) struct ConvertArgs {
    /// The file to read, `-` for stdin, or a catalogue name or signature.
    input: String,
    /// The file to write; format by extension; `-` for stdout.
    #[arg(short, long, value_name = "OUT")]
    output: String,
    #[command(flatten)]
    reading: files::InputArgs,
    #[command(flatten)]
    writing: files::OutputArgs,
}

/// Reads and writes; topology is not judged.
pub(crate) fn run(args: &ConvertArgs, console: &Console) -> anyhow::Result<Exit> {
    args.writing.check(&args.output, &args.reading, console)?;
    let data = if hexfill::is_named(&args.input) {
        files::load_problem(&args.input, &args.reading)?.data()
    } else {
        files::read_data(&args.input, &args.reading)?
    };
    for note in &data.notes {
        console.note(note);
    }
    args.writing.write(&args.output, &data, console)?;
    if console.json && args.output != "-" {
        console.print_json(&serde_json::json!({
            "file": args.output,
            "points": data.points.len(),
            "quads": data.quads.len(),
            "other_faces": data.other_faces.len(),
            "hexes": data.hexes.len(),
        }))?;
    }
    console.say(format!(
        "{}: {} points, {} quads, {} other faces, {}",
        args.output,
        data.points.len(),
        data.quads.len(),
        data.other_faces.len(),
        console::hexes(data.hexes.len())
    ));
    Ok(Exit::Done)
}
