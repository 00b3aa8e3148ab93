#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs)]
use toile_cloth::bench::{Layout, layout::Rectangle};
use toile_cloth::bending::*;
use toile_cloth::fabric::Fabric;
use toile_cloth::force::Vec3;
use toile_cloth::membrane::*;
use toile_cloth::solver::*;
fn main() {
    for layout in Layout::ALL {
        for gamma in [0.1, 10.0, 1000.0] {
            let mesh = Rectangle::new(layout, 0.3, 1.0, 40);
            let sheet = mesh.sheet(1.0).unwrap();
            let fabric = Fabric::isotropic(1.0, 2e4_f64.max(2000.0 * gamma), 0.0, 1.0);
            let d = Rigidity::of(&fabric);
            let mut model =
                Model::of(&sheet).pinned(|v| mesh.at_bottom(v)).under(Vec3::new(0.0, -gamma, 0.0));
            let hinge = Hinge::new(&sheet, &d).unwrap();
            let f = hinge.0.factor();
            model.energies.push(Box::new(Triangles::new(&sheet, Woven::new(&fabric).unwrap())));
            model.energies.push(Box::new(hinge));
            model.energies.push(Box::new(FreeEdge::new(&sheet, &d, |v| !mesh.at_bottom(v)).unwrap()));
            model.energies.push(Box::new(
                Clamp::new(&sheet, &d, f, |v| mesh.at_bottom(v as usize), |_| -Vec3::x()).unwrap(),
            ));
            let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.y, 0.0, p.x)).collect());
            let t = std::time::Instant::now();
            let r = Static::to(1e-7 * gamma).advance(&model, &mut state);
            println!("{} {gamma} factor {f} {r:?} {:.3}s", layout.name(), t.elapsed().as_secs_f64());
        }
    }
}
