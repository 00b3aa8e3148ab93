//! `cargo bench -p toile-guided`: a photo of 12 megapixels.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use toile_core::{Context, testkit};
use toile_guided::{GuidedBy, guided};

fn twelve_megapixels(c: &mut Criterion) {
    let photo = testkit::noisy_photo(4000, 3000).pixels;
    let mut group = c.benchmark_group("12 megapixels");
    group.sample_size(10);
    for by in [GuidedBy::Photo, GuidedBy::Bilateral] {
        group.bench_function(format!("{by:?}"), |b| {
            b.iter(|| black_box(guided(&photo, by, 4, 12.0, &Context::quiet())));
        });
    }
    group.finish();
}

criterion_group!(benches, twelve_megapixels);
criterion_main!(benches);
