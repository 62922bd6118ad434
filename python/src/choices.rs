//! Choices by name.

use crate::failure::Failure;

/// The choice called `given`, a value of the keyword `what`.
pub(crate) fn choice<T: Copy>(what: &str, given: &str, choices: &[(&str, T)]) -> Result<T, Failure> {
    let found = choices.iter().find(|(name, _)| *name == given);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<String> = choices.iter().map(|(name, _)| format!("{name:?}")).collect();
        Failure::input(format!("{what}={given:?}: choose one of {}", names.join(", ")))
    })
}
