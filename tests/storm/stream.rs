//! What a hand that means harm does next.

use ductile_spec::{
    Border, CurveId, Edit, ExportFormat, Extent, Objective, ObjectiveOf, On, PointId, Request, SurfaceId,
    Through,
};
use glam::DVec3;

/// Chooses what the whole document minimises.
pub(crate) fn objective(objective: Objective) -> Request {
    Request::Edit(Edit::Objective { of: ObjectiveOf::Document, objective: Some(objective) })
}

/// Numbers from a fixed stream (splitmix64).
pub(crate) struct Stream(u64);

impl Stream {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.next() >> 33).expect("31 bits fit") % count
    }

    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Somewhere a hand has no business to be.
    pub(crate) fn malice(&mut self, others: &[DVec3]) -> DVec3 {
        let direction = DVec3::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5);
        match self.below(7) {
            0 => direction * 1e9,
            1 => DVec3::new(f64::NAN, 0.0, 0.0),
            2 => DVec3::splat(f64::INFINITY) * direction,
            3 => others[self.below(others.len())],
            4 => direction * 1e-300,
            5 => direction * 1e300,
            _ => direction * 4.0,
        }
    }

    /// An act that contradicts what is there, asks for what is not, or does honest surgery at a bad moment.
    pub(crate) fn surgery(&mut self, others: &[DVec3]) -> Request {
        let point = PointId(u32::try_from(self.below(others.len() + 2)).unwrap() + 1);
        let other = PointId(u32::try_from(self.below(others.len())).unwrap() + 1);
        let curve = CurveId(u32::try_from(self.below(3)).unwrap() + 1);
        let surface = SurfaceId(u32::try_from(self.below(2)).unwrap() + 1);
        let (at, there) = (self.malice(others), others[self.below(others.len())]);
        let [twice, again] = [there, there].map(Through::Place);
        if self.below(3) == 0 {
            return Request::Edit(self.cutting(others, surface, curve));
        }
        Request::Edit(match self.below(16) {
            0 => Edit::Move { point, to: there },
            1 => Edit::Move { point, to: at },
            2 => Edit::Curve { through: vec![twice, again], closed: false },
            3 => Edit::Curve { through: vec![Through::Point(point), twice, again], closed: true },
            4 => Edit::Curve { through: vec![Through::Point(point), Through::Point(other)], closed: false },
            5 => Edit::Sheet { boundary: curve },
            6 => Edit::Sweep { from: curve, to: CurveId(1), stretches: [None; 2], reversed: false },
            7 => Edit::Pin { surface, at },
            8 => Edit::Insert { curve, at },
            9 => Edit::Release { point },
            10 => Edit::DeletePoint { point },
            11 => Edit::DeleteCurve { curve },
            12 => Edit::DeleteSurface { surface },
            13 => Edit::Spacing {
                of: ductile_spec::SpacingOf::Document,
                spacing: Some([0.0, f64::NAN, 1e-12, 1e9, 0.3][self.below(5)]),
            },
            14 => return Request::Export(ExportFormat::Obj),
            _ => return [Request::Undo, Request::Redo, Request::Describe][self.below(3)].clone(),
        })
    }
}

impl Stream {
    /// An act that takes surfaces apart or puts them together, at a bad place.
    fn cutting(&mut self, others: &[DVec3], surface: SurfaceId, curve: CurveId) -> Edit {
        let (at, there) = (self.malice(others), others[self.below(others.len())]);
        let (here, beyond) = (On { surface, at: there * self.unit() }, On { surface, at });
        let (skirt, reversed) = (self.below(2) == 0, self.below(2) == 0);
        let border = if skirt { Border::Curve(curve) } else { Border::Region(here) };
        match self.below(11) {
            0 => Edit::SLoop { surface, along: vec![at, there, there * 0.3], closed: skirt },
            1 => Edit::SLoop { surface, along: vec![here.at, there, -there], closed: skirt },
            // A small ring, which mostly can be drawn: the acts after it have something to cut along.
            2 | 3 => {
                let round = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y].map(|side| here.at + side * 0.3);
                Edit::SLoop { surface, along: round.to_vec(), closed: true }
            }
            4 => Edit::Burnout { region: if skirt { here } else { beyond } },
            5 => Edit::Split { border },
            6 => Edit::Crease { border },
            7 => Edit::Smooth { curve },
            8 => Edit::Glue { from: here, to: beyond, skirt, reversed },
            9 => {
                let radius = [0.2, 0.0, f64::NAN, 1e9, 1e-12][self.below(5)];
                Edit::Merge { from: here, to: beyond, radius, keep: skirt }
            }
            _ if reversed => Edit::Reverse { surface },
            _ => Edit::Expand { curve, to: Extent::Radius([0.5, f64::INFINITY, 1e-12, 1e5][self.below(4)]) },
        }
    }
}
