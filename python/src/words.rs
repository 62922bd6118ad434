//! Texts of the libraries name flags and commands of the command line; from Python they name arguments and functions.

/// What stands in texts, and what Python calls it. Single quotes, since texts also lie in JSON. Longer ones come first.
const WORDS: [(&str, &str); 14] = [
    ("--strategy auto or construct", "strategy='auto' or strategy='construct'"),
    ("--best goes on", "effort='best' goes on"),
    ("--weld TOL", "weld=TOL"),
    // A number follows.
    ("--weld ", "weld="),
    ("(--weld)", "(weld=...)"),
    ("--linearise", "linearise=True"),
    ("--quadratic", "quadratic=True"),
    ("--layers", "layers"),
    ("--refine", "hexfill.mend(..., refine=True)"),
    ("--fix", "hexfill.mend"),
    ("`hexfill check`", "hexfill.check"),
    ("`hexfill doctor`", "hexfill.doctor"),
    ("`hexfill convert`", "hexfill.write"),
    ("`hexfill simplify`", "hexfill.simplify"),
];

/// A text, or JSON with texts, as Python says it.
pub(crate) fn in_python(text: &str) -> String {
    WORDS.iter().fold(text.to_owned(), |text, (flag, argument)| text.replace(flag, argument))
}
