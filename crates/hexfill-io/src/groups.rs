//! Groups of a file (OBJ groups and materials, element and node sets, physical groups of Gmsh) as tags with names.
//!
//! Groups may overlap, a point, face or cell has one tag: every *combination* of groups that occurs is a tag, and the names
//! of a tag are those of its groups. A group that carries a number, as the `tag_7` of this program or the number of a physical
//! group, gives the tag its number; other combinations get the next number that is free, in order of first appearance.
//!
//! Source: ours.

use crate::data::{TagName, TagOn};
use crate::limits::{GROUPS, GROUPS_OF_ONE};
use rustc_hash::{FxHashMap, FxHashSet};

/// One group: its name, its number, or both.
#[derive(Clone, Debug)]
struct Group {
    name: Option<String>,
    number: Option<i64>,
}

/// A combination of groups; [`NONE`] is no group at all.
pub(crate) type Combination = u32;

/// Members of no group.
pub(crate) const NONE: Combination = 0;

/// The groups of a file and the combinations of them met so far.
pub(crate) struct Groups {
    groups: Vec<Group>,
    by_name: FxHashMap<String, u32>,
    by_number: FxHashMap<i64, u32>,
    combinations: Vec<Vec<u32>>,
    known: FxHashMap<Vec<u32>, Combination>,
    /// What a combination and one more group make.
    joined: FxHashMap<(Combination, u32), Combination>,
    /// Some groups were passed over: there are too many, or too many of one member.
    full: bool,
}

/// The tags of the combinations that are used.
pub(crate) struct Tags {
    tags: Vec<i64>,
    names: Vec<(i64, String)>,
}

impl Default for Groups {
    fn default() -> Self {
        Self {
            groups: Vec::new(),
            by_name: FxHashMap::default(),
            by_number: FxHashMap::default(),
            combinations: vec![Vec::new()],
            known: FxHashMap::from_iter([(Vec::new(), NONE)]),
            joined: FxHashMap::default(),
            full: false,
        }
    }
}

/// The number a name carries.
pub(crate) fn carried(name: &str) -> Option<i64> {
    let number = name.strip_prefix("tag_").or_else(|| name.strip_prefix("TAG_")).unwrap_or(name);
    number.parse().ok()
}

/// The name of a tag without one.
pub(crate) fn name_of(tag: i64) -> String {
    format!("tag_{tag}")
}

impl Groups {
    /// The group of a name.
    pub(crate) fn named(&mut self, name: &str) -> u32 {
        if let Some(&group) = self.by_name.get(name) {
            return group;
        }
        let number = carried(name);
        let group = self.add(Group { name: number.is_none().then(|| name.to_owned()), number });
        if !self.full {
            self.by_name.insert(name.to_owned(), group);
        }
        group
    }

    /// The group of a number.
    pub(crate) fn numbered(&mut self, number: i64) -> u32 {
        if let Some(&group) = self.by_number.get(&number) {
            return group;
        }
        let group = self.add(Group { name: None, number: Some(number) });
        if !self.full {
            self.by_number.insert(number, group);
        }
        group
    }

    /// The name of a group that has a number.
    pub(crate) fn set_name(&mut self, number: i64, name: &str) {
        let group = self.numbered(number);
        self.groups[group as usize].name = (carried(name) != Some(number)).then(|| name.to_owned());
    }

    fn add(&mut self, group: Group) -> u32 {
        if self.groups.len() >= GROUPS {
            // All the rest is one group.
            self.full = true;
            return GROUPS as u32 - 1;
        }
        self.groups.push(group);
        self.groups.len() as u32 - 1
    }

    /// The combination of one more group.
    pub(crate) fn join(&mut self, combination: Combination, group: u32) -> Combination {
        if let Some(&joined) = self.joined.get(&(combination, group)) {
            return joined;
        }
        let members = &self.combinations[combination as usize];
        if members.len() >= GROUPS_OF_ONE || self.combinations.len() >= GROUPS {
            self.full |= members.binary_search(&group).is_err();
            return combination;
        }
        let mut members = members.clone();
        if let Err(at) = members.binary_search(&group) {
            members.insert(at, group);
        }
        let next = self.combinations.len() as Combination;
        let joined = *self.known.entry(members.clone()).or_insert(next);
        if joined == next {
            self.combinations.push(members);
        }
        self.joined.insert((combination, group), joined);
        joined
    }

    /// What was passed over because it is too much, in words.
    pub(crate) fn note(&self) -> Option<String> {
        let limit = format!("at most {GROUPS_OF_ONE} groups of one point, face or cell and {GROUPS} of all are kept");
        self.full.then(|| format!("there are too many groups: {limit}"))
    }

    /// Whether a combination is in a group.
    pub(crate) fn contains(&self, combination: Combination, group: u32) -> bool {
        self.combinations[combination as usize].binary_search(&group).is_ok()
    }

    /// The tags of the combinations in `used`, a list with repetitions in order of appearance.
    pub(crate) fn tags(&self, used: impl Iterator<Item = Combination>) -> Tags {
        let mut seen = vec![false; self.combinations.len()];
        let mut order: Vec<Combination> =
            used.filter(|&c| c != NONE && !std::mem::replace(&mut seen[c as usize], true)).collect();
        let members = |c: Combination| &self.combinations[c as usize];
        let number = |c: Combination| members(c).iter().find_map(|&g| self.groups[g as usize].number);
        // Groups by themselves keep their numbers; stable, so that the order of appearance decides the rest.
        order.sort_by_key(|&c| (number(c).is_none(), members(c).len()));
        let reserved: FxHashSet<i64> = order.iter().filter_map(|&c| number(c)).collect();
        let mut tags = vec![0; self.combinations.len()];
        let mut taken = FxHashSet::from_iter([0]);
        let mut next = 1;
        for &c in &order {
            tags[c as usize] = match number(c) {
                // Number 0 is no group.
                Some(n) if taken.insert(n) || n == 0 && members(c).len() == 1 => n,
                _ => {
                    while reserved.contains(&next) || !taken.insert(next) {
                        next += 1;
                    }
                    next
                }
            };
        }
        let mut names = Vec::new();
        for &c in &order {
            let tag = tags[c as usize];
            for group in members(c).iter().map(|&g| &self.groups[g as usize]) {
                let name = match (&group.name, group.number) {
                    (Some(name), _) => name.clone(),
                    (None, Some(number)) if number != tag => name_of(number),
                    _ => continue,
                };
                names.push((tag, name));
            }
        }
        names.sort_by_key(|(tag, _)| *tag);
        Tags { tags, names }
    }
}

impl Tags {
    /// The tag of a combination; 0 for one that is not used.
    pub(crate) fn of(&self, combination: Combination) -> i64 {
        self.tags[combination as usize]
    }

    /// The names of the tags, in order of the tags.
    pub(crate) fn names(&self, on: TagOn) -> impl Iterator<Item = TagName> {
        self.names.iter().map(move |(tag, name)| TagName { on, tag: *tag, name: name.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_carried_and_names_are_numbered_around_them() {
        let mut groups = Groups::default();
        let alone: Vec<Combination> = ["inlet", "tag_1", "-7", "unused", "outlet", "TAG_-2"]
            .iter()
            .map(|name| {
                let group = groups.named(name);
                groups.join(NONE, group)
            })
            .collect();
        let wall = groups.named("wall");
        let both = groups.join(alone[0], wall);
        let inlet = groups.named("inlet");
        assert_eq!(groups.join(both, inlet), both);
        let used = [alone[0], alone[1], alone[1], both, alone[2], alone[4], alone[5], NONE];
        let tags = groups.tags(used.into_iter());
        assert_eq!(alone.iter().map(|&c| tags.of(c)).collect::<Vec<_>>(), [2, 1, -7, 0, 3, -2]);
        assert_eq!((tags.of(both), tags.of(NONE)), (4, 0));
        let names: Vec<_> = tags.names(TagOn::Faces).map(|n| (n.tag, n.name)).collect();
        assert_eq!(names, [(2, "inlet"), (3, "outlet"), (4, "inlet"), (4, "wall")].map(|(t, n)| (t, n.to_owned())));
    }

    #[test]
    fn physical_groups_that_overlap() {
        let mut groups = Groups::default();
        groups.set_name(7, "wall");
        let [a, b] = [3, 7].map(|n| groups.numbered(n));
        let alone = groups.join(NONE, a);
        let both = groups.join(alone, b);
        let tags = groups.tags([both, alone].into_iter());
        assert_eq!((tags.of(alone), tags.of(both)), (3, 7));
        let names: Vec<_> = tags.names(TagOn::Cells).map(|n| (n.tag, n.name)).collect();
        assert_eq!(names, [(7, "wall".to_owned()), (7, "tag_3".to_owned())]);
    }
}
