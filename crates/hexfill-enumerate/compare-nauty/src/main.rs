//! `compare-nauty [N]`: labels the raw children of rule `weill` with N cubes (6 unless told) by this project's canonical form and by
//! nauty, checks that both see the same classes and the same groups, and prints the time of each.
//!
//! The graph: a node per vertex, quad and cube (three colours); quads are joined to their vertices, cubes to their quads. The edges of a
//! cube are the pairs of vertices common to two of its quads, so the graph determines the mesh.
//! `unsafe` is needed for the calls to the C library and for nothing else.

use hexfill_enumerate::{
    Code, Complex, LevelOptions, Params, Rule, Wanted, all_levels, canonical, canonical_over_all_flags, extend_weill,
};
use nauty_Traces_sys::{ADDONEEDGE, SETWORDSNEEDED, TRUE, densenauty, empty_graph, optionblk, statsblk};
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

struct Graph {
    n: usize,
    m: usize,
    words: Vec<u64>,
    /// Nodes by colour: cells of nauty's `lab` and `ptn`.
    cells: [usize; 3],
}

fn graph_of(c: &Complex) -> Graph {
    let mut quads: BTreeMap<BTreeSet<u8>, usize> = BTreeMap::new();
    let mut links = Vec::new();
    for (a, cube) in c.cubes().iter().enumerate() {
        for facet in hexfill_mesh::cube::FACETS {
            let set: BTreeSet<u8> = facet.iter().map(|&i| cube[i]).collect();
            let next = quads.len();
            let q = *quads.entry(set).or_insert(next);
            links.push((a, q));
        }
    }
    let (v, q, h) = (c.n_vertices(), quads.len(), c.n_cubes());
    let n = v + q + h;
    let m = SETWORDSNEEDED(n);
    let mut words = empty_graph(m, n);
    for (set, &quad) in &quads {
        for &vertex in set {
            ADDONEEDGE(&mut words, vertex as usize, v + quad, m);
        }
    }
    for (cube, quad) in links {
        ADDONEEDGE(&mut words, v + quad, v + q + cube, m);
    }
    Graph { n, m, words, cells: [v, q, h] }
}

/// Canonical graph and order of the group.
fn nauty(g: &mut Graph) -> (Vec<u64>, f64) {
    let mut options = optionblk { getcanon: TRUE, defaultptn: 0, ..optionblk::default() };
    let mut stats = statsblk::default();
    let mut lab: Vec<i32> = (0..g.n as i32).collect();
    let mut ptn = vec![1; g.n];
    let mut end = 0;
    for cell in g.cells {
        end += cell;
        ptn[end - 1] = 0;
    }
    let mut orbits = vec![0; g.n];
    let mut canon = empty_graph(g.m, g.n);
    // Safety: all arrays have the lengths nauty asks for (n, or m * n words), and nothing else holds them.
    unsafe {
        densenauty(
            g.words.as_mut_ptr(),
            lab.as_mut_ptr(),
            ptn.as_mut_ptr(),
            orbits.as_mut_ptr(),
            &mut options,
            &mut stats,
            g.m as i32,
            g.n as i32,
            canon.as_mut_ptr(),
        );
    }
    (canon, stats.grpsize1 * 10f64.powi(stats.grpsize2))
}

/// Processor time of this thread (Linux), so that a busy machine does not disturb the comparison.
fn processor_time() -> Duration {
    let text =
        std::fs::read_to_string("/proc/thread-self/schedstat").expect("Linux tells the processor time of a thread");
    let nanoseconds = text.split(' ').next().and_then(|n| n.parse().ok());
    Duration::from_nanos(nanoseconds.expect("the first number is nanoseconds"))
}

fn main() {
    let cubes: usize = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(6);
    let levels = all_levels(
        &Params::new(cubes - 1, Rule::Weill),
        &LevelOptions::default(),
        Wanted::default(),
        true,
        &hexfill_mesh::Context::default(),
    )
    .expect("a small level");
    let parents = &levels[cubes - 2].codes;
    // At most about 100,000 children, evenly spread over the parents.
    let step = parents.len().div_ceil(900);
    let mut children = Vec::new();
    for code in parents.iter().step_by(step) {
        extend_weill(&code.decode().expect("a code just made"), |child, _| children.push(*child));
    }
    println!("{} complexes of {cubes} cubes (children of every {step}th parent)", children.len());

    let start = processor_time();
    let mine: Vec<(Code, u16)> = children
        .iter()
        .map(|c| {
            let l = canonical(c);
            (l.code, l.automorphisms)
        })
        .collect();
    let time_mine = processor_time() - start;
    let start = processor_time();
    let all: usize = children.iter().map(|c| canonical_over_all_flags(c).automorphisms as usize).sum();
    let time_all = processor_time() - start;
    assert_eq!(all, mine.iter().map(|m| m.1 as usize).sum::<usize>());
    let mut graphs: Vec<Graph> = children.iter().map(graph_of).collect();
    let start = processor_time();
    let theirs: Vec<(Vec<u64>, f64)> = graphs.iter_mut().map(nauty).collect();
    let time_nauty = processor_time() - start;

    let mut groups_differ = 0;
    let mut forward: BTreeMap<Code, &Vec<u64>> = BTreeMap::new();
    let mut backward: BTreeMap<&Vec<u64>, Code> = BTreeMap::new();
    let mut classes_differ = 0;
    for ((code, group), (canon, order)) in mine.iter().zip(&theirs) {
        groups_differ += usize::from(f64::from(*group) != *order);
        classes_differ += usize::from(*forward.entry(*code).or_insert(canon) != canon);
        classes_differ += usize::from(*backward.entry(canon).or_insert(*code) != *code);
    }
    let each = |t: std::time::Duration| t.as_secs_f64() * 1e6 / children.len() as f64;
    println!("classes: {} (hexfill), {} (nauty)", forward.len(), backward.len());
    println!("disagreements: {classes_differ} on classes, {groups_differ} on group orders");
    println!("hexfill canonical form:      {:.3} us", each(time_mine));
    println!("hexfill over all flags:      {:.3} us", each(time_all));
    println!("nauty (graph built already): {:.3} us", each(time_nauty));
    println!("ratio nauty / hexfill:       {:.1}", time_nauty.as_secs_f64() / time_mine.as_secs_f64());
    assert_eq!((classes_differ, groups_differ), (0, 0));
}
