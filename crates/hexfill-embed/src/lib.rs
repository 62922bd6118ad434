//! Coordinates for hex meshes: start, untangle, optimise
mod curvature;
mod energy;
mod jacobian;
mod lbfgs;
mod maxmin;
mod problem;
mod program;
mod random;
mod tutte;
mod untangle;
mod vector;

#[cfg(test)]
mod scratch {
    use super::*;
    #[test]
    fn pyr() {
        let s = std::fs::read_to_string(std::env::var("MESH").unwrap_or("/tmp/emb/pyr36.txt".into())).unwrap();
        let mut l = s.lines();
        let head: Vec<usize> = l.next().unwrap().split(' ').map(|x| x.parse().unwrap()).collect();
        let mut points = vec![[0.0; 3]; head[1]];
        for p in points.iter_mut().take(head[0]) {
            let v: Vec<f64> = l.next().unwrap().split(' ').map(|x| x.parse().unwrap()).collect();
            *p = [v[0], v[1], v[2]];
        }
        let hexes: Vec<[u32; 8]> = l
            .map(|l| {
                let v: Vec<u32> = l.split(' ').map(|x| x.parse().unwrap()).collect();
                v.try_into().unwrap()
            })
            .collect();
        let fixed: Vec<bool> = (0..head[1]).map(|v| v < head[0]).collect();
        let problem = problem::Problem::new(head[1], hexes, &fixed);
        for seed in 0..6 {
            let mut p = points.clone();
            let t = std::time::Instant::now();
            let mut r = random::Random::new(7, seed);
            tutte::place(&problem, &mut p, if seed == 0 { 0.0 } else { 1.0 }, &mut r);
            let t1 = t.elapsed();
            let u = untangle::untangle(&problem, &mut p, untangle::UntangleLimits { rounds: 100, iterations: 100, extra_rounds: 0 }, &Default::default());
            let q = problem.hexes.iter().enumerate().map(|(h, _)| jacobian::Frame::new(&problem.corners_of(h, &p)).corner_minimum()).fold(1.0, f64::min);
            let t2 = std::time::Instant::now();
            println!("{seed} {u:?} tutte {t1:?} all {:?} min SJ {q}", t.elapsed());
            let m = maxmin::maximise(&problem, &mut p, maxmin::MaxMinLimits { iterations: 150, target: 1.0, band: 0.3, tolerance: 1e-9 }, &Default::default());
            let (lo, up) = problem.hexes.iter().enumerate().map(|(h, _)| jacobian::Frame::new(&problem.corners_of(h, &p)).worst(1.0, 1e-7, 10000)).fold((1.0f64, 1.0f64), |a, b| (a.0.min(b.lower), a.1.min(b.upper)));
            println!("   {m:?} {lo} {up} {:?}", t2.elapsed());
        }
    }
}
