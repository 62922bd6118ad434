//! Named groups (OBJ groups, element sets) as tags.
//!
//! A name that carries a number, `tag_7` or plain `7`, is that tag; every other name gets the next number that is free,
//! in order of first appearance, and a note says which. So tags written by this program come back exactly, and the groups
//! of other programs at least stay apart.

use rustc_hash::{FxHashMap, FxHashSet};

/// The names met so far, each with a stand-in number from 0.
#[derive(Default)]
pub(crate) struct Names {
    names: Vec<String>,
    index: FxHashMap<String, usize>,
}

/// The number a name carries.
fn carried(name: &str) -> Option<i64> {
    let number = name.strip_prefix("tag_").or_else(|| name.strip_prefix("TAG_")).unwrap_or(name);
    number.parse().ok()
}

/// The name of a tag.
pub(crate) fn name_of(tag: i64) -> String {
    format!("tag_{tag}")
}

impl Names {
    /// The stand-in of a name.
    pub(crate) fn stand_in(&mut self, name: &str) -> usize {
        if let Some(&i) = self.index.get(name) {
            return i;
        }
        self.names.push(name.to_owned());
        self.index.insert(name.to_owned(), self.names.len() - 1);
        self.names.len() - 1
    }

    /// The tag of each stand-in, and a note for each name that carries no number. `used` are the stand-ins that matter.
    pub(crate) fn tags(&self, used: &[bool], what: &str) -> (Vec<i64>, Vec<String>) {
        let mut notes = Vec::new();
        let mut taken: FxHashSet<i64> = self.names.iter().filter_map(|n| carried(n)).collect();
        let mut next = 1;
        let tags = self.names.iter().enumerate().map(|(i, name)| {
            if let Some(tag) = carried(name) {
                return tag;
            }
            if !used.get(i).copied().unwrap_or(false) {
                return 0;
            }
            while !taken.insert(next) {
                next += 1;
            }
            notes.push(format!("{what} `{name}` is tag {next}"));
            next
        });
        let tags = tags.collect();
        (tags, notes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_carried_and_names_are_numbered_around_them() {
        let mut names = Names::default();
        for (i, name) in ["inlet", "tag_1", "-7", "unused", "outlet", "TAG_-2"].iter().enumerate() {
            assert_eq!(names.stand_in(name), i);
        }
        assert_eq!(names.stand_in("inlet"), 0);
        let (tags, notes) = names.tags(&[true, true, true, false, true, true], "group");
        assert_eq!(tags, [2, 1, -7, 0, 3, -2]);
        assert_eq!(notes, ["group `inlet` is tag 2", "group `outlet` is tag 3"]);
    }
}
