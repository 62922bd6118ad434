//! A sharded open-addressing set of hashes: 16 (or 8) bytes an entry, shared by threads.
//!
//! The keys are hashes already, so their own bits choose shard and slot. Memory doubles shard by shard when a shard is
//! three quarters full; the largest momentary need is one shard's copy.
//!
//! Source: ours.

use std::sync::{Mutex, PoisonError};

/// A hash of fixed width, never zero (zero marks an empty slot).
pub(crate) trait HashKey: Copy + Eq + Send {
    /// The empty slot.
    const EMPTY: Self;
    /// The key of a 128-bit hash.
    fn of(hash: u128) -> Self;
    /// Bits to choose the slot by.
    fn low(self) -> u64;
}

impl HashKey for u128 {
    const EMPTY: Self = 0;
    fn of(hash: u128) -> Self {
        hash.max(1)
    }
    fn low(self) -> u64 {
        self as u64
    }
}

impl HashKey for u64 {
    const EMPTY: Self = 0;
    fn of(hash: u128) -> Self {
        // The high half: another function of the code than the slot bits of the wide key.
        ((hash >> 64) as u64).max(1)
    }
    fn low(self) -> u64 {
        self
    }
}

/// One open-addressing table.
pub(crate) struct OpenSet<K> {
    slots: Vec<K>,
    len: usize,
}

impl<K: HashKey> OpenSet<K> {
    pub(crate) fn new() -> Self {
        Self { slots: vec![K::EMPTY; 16], len: 0 }
    }

    #[inline]
    fn slot(&self, key: K) -> usize {
        let mask = self.slots.len() - 1;
        // The low six bits chose the shard.
        let mut at = (key.low() >> 6) as usize & mask;
        while self.slots[at] != K::EMPTY && self.slots[at] != key {
            at = (at + 1) & mask;
        }
        at
    }

    /// Adds a key; whether it was new.
    pub(crate) fn insert(&mut self, key: K) -> bool {
        let at = self.slot(key);
        if self.slots[at] == key {
            return false;
        }
        self.slots[at] = key;
        self.len += 1;
        if 4 * self.len > 3 * self.slots.len() {
            let bigger = vec![K::EMPTY; 2 * self.slots.len()];
            let old = std::mem::replace(&mut self.slots, bigger);
            for key in old {
                if key != K::EMPTY {
                    let at = self.slot(key);
                    self.slots[at] = key;
                }
            }
        }
        true
    }

    #[inline]
    pub(crate) fn contains(&self, key: K) -> bool {
        self.slots[self.slot(key)] == key
    }

    pub(crate) fn bytes(&self) -> u64 {
        (self.slots.len() * size_of::<K>()) as u64
    }
}

const SHARDS: usize = 64;

/// A set of hashes that several threads insert into.
pub(crate) struct ShardedSet<K> {
    shards: Vec<Mutex<OpenSet<K>>>,
}

impl<K: HashKey> ShardedSet<K> {
    pub(crate) fn new() -> Self {
        Self { shards: (0..SHARDS).map(|_| Mutex::new(OpenSet::new())).collect() }
    }

    /// Adds a hash; whether it was new.
    #[inline]
    pub(crate) fn insert(&self, hash: u128) -> bool {
        let key = K::of(hash);
        let shard = &self.shards[key.low() as usize % SHARDS];
        // A panic elsewhere leaves a table whole: insertion has no half-done state that unwinding could expose.
        shard.lock().unwrap_or_else(PoisonError::into_inner).insert(key)
    }

    /// Bytes held by the tables.
    pub(crate) fn bytes(&self) -> u64 {
        self.shards.iter().map(|s| s.lock().unwrap_or_else(PoisonError::into_inner).bytes()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inserted_once_found_always() {
        let wide = ShardedSet::<u128>::new();
        let narrow = ShardedSet::<u64>::new();
        let mut plain = OpenSet::<u128>::new();
        for round in 0..2 {
            for i in 0..5000u128 {
                let hash = i.wrapping_mul(0x9e37_79b9_7f4a_7c15_f39c_c060_5ced_c835);
                assert_eq!(wide.insert(hash), round == 0);
                assert_eq!(narrow.insert(hash), round == 0);
                assert_eq!(plain.insert(u128::of(hash)), round == 0);
                assert!(plain.contains(u128::of(hash)));
            }
        }
        assert!(!plain.contains(12345));
        assert!(wide.bytes() >= 5000 * 16);
    }
}
