//! `cargo bench -p toile-tutorial`

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use toile_core::artifact::Photo;
use toile_core::testkit;
use toile_tutorial::Dust;

fn dust(c: &mut Criterion) {
    let photo = testkit::noisy_photo(1000, 1000);
    c.bench_function("dust on a megapixel", |b| {
        b.iter(|| black_box(testkit::run_one::<Photo>(&Dust::default(), &photo)));
    });
}

criterion_group!(benches, dust);
criterion_main!(benches);
