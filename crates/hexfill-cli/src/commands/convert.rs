//! `hexfill convert IN -o OUT`.

use crate::console::Console;
use crate::exit::Exit;
use crate::files;
use hexfill::io::Format;

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
    /// Format of the output.
    #[arg(long, value_name = "FORMAT", value_parser = files::parse_format)]
    to: Option<Format>,
}

/// Reads and writes; topology is not judged.
pub(crate) fn run(args: &ConvertArgs, console: &Console) -> anyhow::Result<Exit> {
    files::check_output(&args.output, args.to)?;
    let data = if hexfill::is_named(&args.input) {
        files::load_problem(&args.input, &args.reading)?.data()
    } else {
        files::read_data(&args.input, &args.reading)?
    };
    for note in &data.notes {
        console.note(note);
    }
    files::write_data(&args.output, args.to, &data, console)?;
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
        "{}: {} points, {} quads, {} other faces, {} hexes",
        args.output,
        data.points.len(),
        data.quads.len(),
        data.other_faces.len(),
        data.hexes.len()
    ));
    Ok(Exit::Done)
}
