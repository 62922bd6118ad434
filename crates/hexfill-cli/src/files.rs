//! Small parsers for flags, and reading and writing where `-` means stdin and stdout.

use crate::console::Console;
use anyhow::{Context as _, Result, bail};
use hexfill::Problem;
use hexfill::io::{Format, MeshData, WriteError};
use std::path::Path;
use std::time::Duration;

/// `90`, `90s`, `1.5m`, `2h`.
pub(crate) fn parse_duration(text: &str) -> Result<Duration, String> {
    let (number, unit) = split_unit(text);
    let seconds = match unit {
        "" | "s" => 1.0,
        "ms" => 1e-3,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(format!("unknown unit `{unit}`; use s, m or h")),
    };
    let value: f64 = number.parse().map_err(|_| format!("`{text}` is no time; write 90, 90s, 10m or 2h"))?;
    Duration::try_from_secs_f64(value * seconds).map_err(|e| e.to_string())
}

/// `1000000`, `800M`, `6G`, `6GiB`.
pub(crate) fn parse_size(text: &str) -> Result<u64, String> {
    let (number, unit) = split_unit(text);
    let scale = match unit.to_ascii_uppercase().as_str() {
        "" | "B" => 1u64,
        "K" | "KB" | "KIB" => 1 << 10,
        "M" | "MB" | "MIB" => 1 << 20,
        "G" | "GB" | "GIB" => 1 << 30,
        _ => return Err(format!("unknown unit `{unit}`; use K, M or G")),
    };
    let value: f64 = number.parse().map_err(|_| format!("`{text}` is no size; write bytes, 800M or 6G"))?;
    if value.is_finite() && value >= 0.0 { Ok((value * scale as f64) as u64) } else { Err("size out of range".into()) }
}

fn split_unit(text: &str) -> (&str, &str) {
    let at = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    (&text[..at], &text[at..])
}

/// `--from` and `--to`: a format by name.
pub(crate) fn parse_format(text: &str) -> Result<Format, String> {
    Format::from_name(text).map_err(|e| e.to_string())
}

/// How input is read: flags of all commands that take surfaces.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct InputArgs {
    /// Format of the input.
    #[arg(long, value_name = "FORMAT", value_parser = parse_format)]
    pub from: Option<Format>,
    /// Merge points of the input that are at most this far apart, in its unit; 0: points with the same coordinates. Closes the seams
    /// that exporters leave.
    #[arg(long, value_name = "TOL", value_parser = parse_tolerance)]
    pub weld: Option<f64>,
    /// Read cells of higher order (quad8, quad9, hex20, ...) as their corners; the points between these are dropped.
    #[arg(long, visible_alias = "linearize")]
    pub linearise: bool,
}

impl From<Option<Format>> for InputArgs {
    fn from(from: Option<Format>) -> Self {
        Self { from, ..Self::default() }
    }
}

/// `--weld`: a distance.
fn parse_tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err(format!("`{text}` is no distance; write 0, 1e-6 or 0.01")),
    }
}

/// What a file or stdin holds, with the flags applied.
pub(crate) fn read_data(input: &str, how: &InputArgs) -> Result<MeshData> {
    let mut data = if input == "-" {
        let Some(format) = how.from else { bail!("reading stdin: name its format with --from") };
        hexfill::io::read_from(std::io::stdin().lock(), format, "stdin")?
    } else {
        check_input(input)?;
        hexfill::io::read_path(Path::new(input), how.from)?
    };
    if how.linearise {
        data = data.linearised();
    }
    if !data.middles.is_empty() {
        bail!(
            "{input} has cells of higher order (quad8, quad9, hex20, ...), {} of its points lie between corners; add --linearise to read \
             the corners alone (fill, embed, convert, check, info), or export straight cells",
            data.middles.len()
        );
    }
    if let Some(tolerance) = how.weld {
        let welded = hexfill::io::weld(&mut data, tolerance);
        if welded.collapsed > 0 {
            let n = welded.collapsed;
            bail!(
                "--weld {tolerance} merges corners of {n} faces or cells of {input} with each other; use a smaller tolerance"
            );
        }
        data.notes.push(format!(
            "--weld {tolerance}: {} points merged into others, {} are left",
            welded.merged,
            data.points.len()
        ));
    }
    Ok(data)
}

/// The problem named by a file, stdin, a catalogue name or a signature.
pub(crate) fn load_problem(input: &str, how: &InputArgs) -> Result<Problem> {
    if hexfill::is_named(input) {
        return Ok(Problem::load(input, None)?);
    }
    let name = if input == "-" { "stdin" } else { input };
    Ok(Problem::from_data(name, &read_data(input, how)?)?)
}

/// How a mesh is written: flags of the commands that write one of any kind.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct OutputArgs {
    /// Format of the output.
    #[arg(long, value_name = "FORMAT", value_parser = parse_format)]
    pub to: Option<Format>,
    /// Write cells of second order on straight edges (20-node hexes, 8-node quads): a node in the middle of every edge. Valid as the
    /// straight ones are. For .vtk, .vtu, .msh, .inp, .bdf and .unv.
    #[arg(long)]
    pub quadratic: bool,
}

impl OutputArgs {
    /// Refuses an output path before any work is done: unknown extension, missing folder, a format without cells of second order.
    pub(crate) fn check(&self, output: &str, reading: &InputArgs, console: &Console) -> Result<()> {
        check_output(output, self.to)?;
        if self.quadratic && reading.linearise {
            console.note("--quadratic puts nodes in the middles of straight edges: nodes of the input between corners, which --linearise drops, do not come back");
        }
        let format = self.to.map_or_else(|| Format::from_path(Path::new(output)), Ok)?;
        if self.quadratic {
            WriteError::check_quadratic(format).with_context(|| output.to_owned())?;
        }
        Ok(())
    }

    /// Refuses the path of a mesh before any work is done. `surface`: its boundary.
    pub(crate) fn check_mesh(&self, output: &str, surface: &MeshData) -> Result<()> {
        check_mesh_output(output, self.to, surface)?;
        if self.quadratic {
            surface.check_straight()?;
        }
        Ok(())
    }

    /// Writes as the flags say; see [`write_data`].
    pub(crate) fn write(&self, output: &str, data: &MeshData, console: &Console) -> Result<()> {
        if self.quadratic {
            return write_data(output, self.to, &data.clone().into_quadratic()?, console);
        }
        write_data(output, self.to, data, console)
    }
}

/// Writes to a path (format by extension unless given) or, for `-`, to stdout; notes what the format cannot hold.
pub(crate) fn write_data(output: &str, to: Option<Format>, data: &MeshData, console: &Console) -> Result<()> {
    let format = match to {
        Some(format) => Some(format),
        None => Format::from_path(Path::new(output)).ok(),
    };
    for loss in format.map_or_else(Vec::new, |format| data.losses(format)) {
        console.note(loss);
    }
    if output == "-" {
        let Some(format) = to else { bail!("writing stdout: name its format with --to") };
        return Ok(hexfill::io::write_to(std::io::stdout().lock(), format, data)?);
    }
    Ok(hexfill::io::write_path(Path::new(output), to, data)?)
}

/// Refuses an output path before any work is done: unknown extension, missing folder.
pub(crate) fn check_output(output: &str, to: Option<Format>) -> Result<()> {
    if output == "-" {
        return if to.is_some() { Ok(()) } else { bail!("writing stdout: name its format with --to") };
    }
    if to.is_none() {
        Format::from_path(Path::new(output))?;
    }
    check_folder(output)
}

/// Refuses the path of a mesh before any work is done. `surface`: its boundary.
pub(crate) fn check_mesh_output(output: &str, to: Option<Format>, surface: &MeshData) -> Result<()> {
    let path = Path::new(output);
    let format = to.map_or_else(|| Format::from_path(path), Ok)?;
    if !format.holds_cells() {
        bail!(
            "{output}: {} cannot hold hexahedra; use a mesh format such as .vtk, .vtu, .mesh or .msh",
            format.title()
        );
    }
    Ok(hexfill::io::check_path(path, to, surface)?)
}

/// Refuses a path that cannot be written: a folder, or in a folder that does not exist or takes no files.
pub(crate) fn check_folder(output: &str) -> Result<()> {
    // Through a symbolic link to the file it names, as it is written.
    let target = std::fs::canonicalize(output).unwrap_or_else(|_| Path::new(output).to_owned());
    if target.is_dir() {
        bail!("{output} is a folder; give the name of a file in it");
    }
    let folder = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        bail!("{output}: the folder {} does not exist; create it first", folder.display());
    }
    // Files appear by way of a temporary one beside them; devices and pipes are written directly.
    if !target.exists() || target.is_file() {
        let refused = || format!("{output}: the folder {} takes no files", folder.display());
        tempfile::Builder::new().prefix(".hexfill-").tempfile_in(folder).with_context(refused)?;
    }
    Ok(())
}

/// Refuses to read and write, or to write twice, the same file. `-` is never the same.
pub(crate) fn check_distinct(paths: &[&str]) -> Result<()> {
    let real = |path: &str| std::fs::canonicalize(path).unwrap_or_else(|_| Path::new(path).to_owned());
    for (i, a) in paths.iter().enumerate().filter(|(_, a)| **a != "-") {
        if let Some(b) = paths[..i].iter().find(|b| real(b) == real(a)) {
            bail!("{b} and {a} are the same file; give different names");
        }
    }
    Ok(())
}

/// What an input is called in titles: the name of the file without its folders, a catalogue name as it is.
pub(crate) fn short_name(input: &str) -> &str {
    if hexfill::is_named(input) {
        return input;
    }
    Path::new(input).file_name().and_then(|name| name.to_str()).unwrap_or(input)
}

/// Refuses what is no file with a plain word.
fn check_input(input: &str) -> Result<()> {
    match std::fs::metadata(input) {
        Ok(found) if found.is_dir() => bail!("{input} is a folder; give a file"),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => bail!("{input}: no such file"),
        _ => Ok(()),
    }
}

/// Writes a text or binary file by way of a temporary one beside it.
pub(crate) fn write_file(path: &str, write: impl FnOnce(&mut std::fs::File) -> std::io::Result<()>) -> Result<()> {
    let target = Path::new(path);
    let folder = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = tempfile::Builder::new().prefix(".hexfill-").tempfile_in(folder).with_context(|| path.to_owned())?;
    write(file.as_file_mut()).with_context(|| path.to_owned())?;
    let file = file.persist(target).with_context(|| path.to_owned())?;
    #[cfg(unix)]
    {
        // Temporary files are private; a result is an ordinary file.
        use std::os::unix::fs::PermissionsExt;
        file.set_permissions(std::fs::Permissions::from_mode(0o644)).with_context(|| path.to_owned())?;
    }
    drop(file);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_sizes_are_understood() {
        assert_eq!(parse_duration("90").unwrap(), Duration::from_secs(90));
        assert_eq!(parse_duration("1.5m").unwrap(), Duration::from_secs(90));
        assert_eq!(parse_size("6G").unwrap(), 6 << 30);
        assert!(
            parse_duration("soon").is_err() && parse_duration("5 parsecs").is_err() && parse_duration("-1").is_err()
        );
        assert!(parse_size("many").is_err() && parse_size("-1G").is_err());
    }
}
