//! Speed of the parts (processor time, so that a busy machine does not disturb) and of whole levels (time that passes).
//! Dated results are in `record/`.

use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use hexfill_enumerate::{
    Chunk, Code, Complex, LevelOptions, Params, Plan, Rule, StrictOptions, Wanted, all_levels, canonical,
    canonical_over_all_flags, extend_strict, extend_weill, run_whole,
};
use hexfill_mesh::Context;
use std::hint::black_box;

/// Processor time of this thread in nanoseconds where Linux tells it, else time that passes.
struct ProcessorTime(WallTime);

impl Measurement for ProcessorTime {
    type Intermediate = (Option<u64>, <WallTime as Measurement>::Intermediate);
    type Value = std::time::Duration;

    fn start(&self) -> Self::Intermediate {
        (thread_nanoseconds(), self.0.start())
    }

    fn end(&self, (start, wall): Self::Intermediate) -> Self::Value {
        match (start, thread_nanoseconds()) {
            (Some(start), Some(end)) => std::time::Duration::from_nanos(end - start),
            _ => self.0.end(wall),
        }
    }

    fn add(&self, a: &Self::Value, b: &Self::Value) -> Self::Value {
        *a + *b
    }

    fn zero(&self) -> Self::Value {
        std::time::Duration::ZERO
    }

    fn to_f64(&self, value: &Self::Value) -> f64 {
        value.as_nanos() as f64
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        self.0.formatter()
    }
}

fn thread_nanoseconds() -> Option<u64> {
    std::fs::read_to_string("/proc/thread-self/schedstat").ok()?.split(' ').next()?.parse().ok()
}

/// Every `step`-th class of a level under rule weill, decoded.
fn sample(cubes: usize, step: usize) -> Vec<Complex> {
    let levels = all_levels(
        &Params::new(cubes, Rule::Weill),
        &LevelOptions::default(),
        Wanted::default(),
        true,
        &Context::default(),
    )
    .expect("a small level");
    levels[cubes - 1].codes.iter().step_by(step).map(|c: &Code| c.decode().expect("a code just made")).collect()
}

fn parts(c: &mut Criterion<ProcessorTime>) {
    let seven = sample(7, 384);
    let mut group = c.benchmark_group("seven cubes");
    group.throughput(Throughput::Elements(seven.len() as u64));
    group.bench_function("canonical form", |b| {
        b.iter(|| seven.iter().map(|x| canonical(black_box(x)).automorphisms as usize).sum::<usize>());
    });
    group.bench_function("canonical form over all flags", |b| {
        b.iter(|| seven.iter().map(|x| canonical_over_all_flags(black_box(x)).automorphisms as usize).sum::<usize>());
    });
    group.bench_function("extend weill (per parent)", |b| {
        b.iter(|| {
            let mut n = 0;
            seven.iter().for_each(|x| extend_weill(black_box(x), |_, _| n += 1));
            n
        });
    });
    group.bench_function("extend strict (per parent)", |b| {
        b.iter(|| {
            let mut n = 0;
            seven.iter().for_each(|x| extend_strict(black_box(x), StrictOptions::default(), |_, _| n += 1));
            n
        });
    });
    group.finish();
}

fn levels(c: &mut Criterion) {
    let ctx = Context::default();
    let mut group = c.benchmark_group("levels");
    group.sample_size(10);
    for threads in [1, 2] {
        group.throughput(Throughput::Elements(112_650));
        group.bench_function(format!("strict 7, {threads} threads"), |b| {
            b.iter(|| {
                let plan =
                    Plan::prepare(&Params::new(7, Rule::Strict), &LevelOptions::default(), &ctx).expect("a plan");
                run_whole(&plan, threads, Wanted::default(), &ctx).expect("not stopped").0.classes
            });
        });
        group.throughput(Throughput::Elements(384_653));
        group.bench_function(format!("weill 7, {threads} threads"), |b| {
            let options = LevelOptions::default().with_threads(threads);
            b.iter(|| {
                all_levels(&Params::new(7, Rule::Weill), &options, Wanted::default(), false, &ctx).expect("not stopped")
                    [6]
                .tally
                .classes
            });
        });
    }
    group.bench_function("strict 8, chunk 100 of 240", |b| {
        let plan = Plan::prepare(&Params::new(8, Rule::Strict), &LevelOptions::default(), &ctx).expect("a plan");
        b.iter(|| plan.run(Chunk { index: 100, of: 240 }, Wanted::default(), &ctx).expect("not stopped").tally.classes);
    });
    group.finish();
}

criterion_group! {
    name = of_parts;
    config = Criterion::default().with_measurement(ProcessorTime(WallTime));
    targets = parts
}
criterion_group!(of_levels, levels);
criterion_main!(of_parts, of_levels);
