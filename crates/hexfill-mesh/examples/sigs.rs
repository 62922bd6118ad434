fn main() {
    for n in [12usize, 14, 16] {
        for s in hexfill_mesh::generate::all_spheres(n) { println!("{n} {}", hexfill_mesh::surface_signature(&s)); }
    }
}
