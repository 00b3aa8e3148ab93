//! What the plugin ABI costs: the same stage, linked in and loaded.
//!
//!     cargo bench -p toile-tests --bench plugins
#![allow(clippy::unwrap_used, missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use std::sync::Arc;
use std::time::Duration;
use toile_core::artifact::{Photo, Shared};
use toile_core::{Context, Inputs, PortValue, Registry};
use toile_pipeline::plugin::load_plugin;
use toile_tests::plugins::{library, vest_on_sdf};

/// Linked in, and loaded.
fn registries(name: &str, register: fn(&mut Registry)) -> [(&'static str, Registry); 2] {
    let (mut linked, mut loaded) = (toile::registry(), toile::registry());
    register(&mut linked);
    load_plugin(&mut loaded, &library(name), None).unwrap();
    [("linked", linked), ("loaded", loaded)]
}

/// A photo of 12 megapixels through a stage that passes it on: nothing but the plugin ABI.
fn picture(c: &mut Criterion) {
    let mut group = c.benchmark_group("photo of 12 megapixels");
    group.sample_size(20);
    let photo = Photo {
        pixels: Shared::new(image::RgbImage::from_fn(4000, 3000, |x, y| image::Rgb([x as u8, y as u8, 7]))),
        alpha: None,
        px_per_metre: None,
        garment_width: None,
        mirrored: false,
        joined: 1,
        file: String::new(),
    };
    let inputs = Inputs(vec![Some(PortValue::One(Arc::new(photo)))]);
    for (how, registry) in registries("toile_faulty", toile_faulty::register) {
        for name in ["PanicsInDrop", "Shades"] {
            let stage = registry.make(registry.card(name).unwrap(), "()").unwrap();
            let what = if name == "Shades" { "every level multiplied" } else { "passed on" };
            group.bench_function(format!("{what}, {how}"), |b| {
                b.iter(|| stage.run_ports(&inputs, &Context::quiet()).unwrap());
            });
        }
    }
    group.finish();
}

/// The vest sewn and draped against a collider that is asked in the solver's inner loop.
fn collider(c: &mut Criterion) {
    let mut group = c.benchmark_group("vest at rest on SdfCollider");
    group.sample_size(10).measurement_time(Duration::from_secs(60));
    for (how, registry) in registries("toile_sdf", toile_sdf::register) {
        group.bench_function(how, |b| {
            b.iter_custom(|times| (0..times).map(|_| solve(&registry)).sum());
        });
    }
    group.finish();
}

/// The time of the solve alone.
fn solve(registry: &Registry) -> Duration {
    let done = vest_on_sdf(registry).unwrap();
    let rest = done.log.stages.iter().find(|s| s.id == "StaticEquilibrium").unwrap();
    Duration::from_secs_f64(rest.wall_s)
}

criterion_group!(benches, picture, collider);
criterion_main!(benches);
