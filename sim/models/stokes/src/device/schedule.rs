//! The dispatches of a step, independent of the paint. The algorithm is that of `unified.rs` of maulstick-stokes.

use maulstick_stokes::flow::Effort;

use super::kernels::{KERNELS, Stage};
use super::plan::{DIRECTIONS, Plan, SUMMED};
use super::record::Call;

/// Number of invocations of a workgroup.
const GROUP: u32 = 256;
/// Number of workgroups in a row.
const ROW: u32 = 32_768;
/// Fields of window.wgsl.
const LACKING: u32 = 42;
const ANSWER: u32 = 43;
const X: u32 = 44;
const B: u32 = 48;
const R: u32 = 52;

/// A dispatch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dispatch {
    pub(crate) stage: Stage,
    pub(crate) groups: [u32; 3],
    pub(crate) call: Call,
}

/// Purpose of a sum, by add_up.wgsl's numbers.
#[derive(Clone, Copy, Debug)]
enum Wanted {
    Thickness,
    Shares,
    Answer,
    Weights,
    Mean,
    Turn,
    Reach,
    MoreShares,
    LastAnswer,
}

/// The dispatches of a step in order, and their bytes.
#[derive(Debug)]
pub(crate) struct Schedule<'a> {
    plan: &'a Plan,
    pub(crate) dispatches: Vec<Dispatch>,
    pub(crate) bytes: u64,
}

impl<'a> Schedule<'a> {
    /// The dispatches of a step.
    pub(crate) fn new(plan: &'a Plan, effort: Effort) -> Self {
        let mut schedule = Self {
            plan,
            dispatches: Vec::new(),
            bytes: 0,
        };
        if plan.paints.count > 0 {
            schedule.each(Stage::FillWindow, 1, Call::default());
        }
        schedule.find_domain();
        schedule.find_operator();
        schedule.solve(effort.steps);
        schedule.project(effort.projections);
        schedule.each(Stage::EndStep, 4, Call::default());
        if plan.paints.count > 0 {
            schedule.carry();
        }
        schedule
    }

    fn find_domain(&mut self) {
        for (stage, fields) in [
            (Stage::FindFaces, 3),
            (Stage::FindCells, 1),
            (Stage::FindFree, 3),
            (Stage::FindEdges, 3),
        ] {
            self.all(0, stage, fields, Call::default());
        }
        let columns = self.plan.grid.cells[0] * self.plan.grid.cells[1];
        let groups = (columns as u32).div_ceil(SUMMED);
        let call = Call {
            groups,
            ..Call::default()
        };
        self.dispatch(
            Stage::WeighColumns,
            [groups, 1, 1],
            call,
            u64::from(self.plan.inner(0)),
        );
        self.add_up(Wanted::Thickness, call);
    }

    fn find_operator(&mut self) {
        let plain = Call::default();
        self.all(0, Stage::ChooseVelocity, 3, plain);
        self.each(Stage::FindViscosity, 1, plain);
        self.all(0, Stage::WeighEdges, 3, plain);
        self.all(0, Stage::FindStencil, 4, plain);
        for level in 0..self.plan.levels.len() {
            let call = Call {
                level: level as u32,
                ..plain
            };
            if level > 0 {
                let finer = Call {
                    level: level as u32 - 1,
                    ..plain
                };
                self.all(level, Stage::Coarsen, 24, finer);
                self.inner(level - 1, Stage::FindScale, 4, finer);
            }
            self.inner(level, Stage::InvertDiagonal, 4, call);
        }
        self.each(Stage::FindBulk, 1, plain);
        self.each(Stage::FindRight, 4, plain);
    }

    /// Solves for velocity and pressure.
    fn solve(&mut self, steps: usize) {
        let [x, r] = [X, R].map(|number| self.plan.field(number));
        let call = Call {
            source: x,
            into: r,
            mode: 1,
            ..Call::default()
        };
        self.each(Stage::ApplyOperator, 4, call);
        let call = Call {
            mode: 1,
            ..Call::default()
        };
        self.summed(Stage::AnswerResidual, 4, 0, call);
        let mut done = 0;
        while done < steps {
            let some = (steps - done).min(self.plan.memory);
            for number in 0..some {
                self.precondition(number, r);
                self.add_direction(number, done + number);
            }
            done += some;
            self.end_directions(some, done);
        }
    }

    fn direction(&self, number: usize) -> u32 {
        self.plan.field(DIRECTIONS + 8 * number as u32)
    }

    fn precondition(&mut self, number: usize, r: u32) {
        let z = self.direction(number);
        let [three, lacking, answer] = [3, LACKING, ANSWER].map(|number| self.plan.field(number));
        self.cycle([0, 3], r, z);
        let call = Call {
            source: z,
            into: r + three,
            ..Call::default()
        };
        self.each(Stage::FindLacking, 1, call);
        self.cycle([3, 1], lacking, answer);
        let call = Call {
            into: z + three,
            ..Call::default()
        };
        self.each(Stage::MixPressure, 1, call);
        let call = Call {
            source: z,
            into: z + self.plan.field(4),
            ..Call::default()
        };
        self.each(Stage::ApplyOperator, 4, call);
    }

    /// Adds a direction, the `done`th of the step.
    fn add_direction(&mut self, number: usize, done: usize) {
        let before = number as u64;
        let call = Call {
            number: number as u32,
            axis: done as u32,
            ..Call::default()
        };
        if number > 0 {
            self.summed(Stage::MultiplyImages, 4, before, call);
            self.add_up(Wanted::Shares, self.summing(4, call));
        }
        self.summed(Stage::TakeShares, 4, before, call);
        self.add_up(Wanted::Answer, self.summing(4, call));
        if number > 0 {
            // The second round returns at once unless cancellation has made the first inexact; its bytes are not
            // counted.
            let again = Call { mode: 1, ..call };
            let bytes = self.bytes;
            self.summed(Stage::MultiplyImages, 4, before, again);
            self.add_up(Wanted::MoreShares, self.summing(4, call));
            self.summed(Stage::TakeShares, 4, before, again);
            self.add_up(Wanted::LastAnswer, self.summing(4, call));
            self.bytes = bytes;
        }
        self.summed(Stage::AnswerResidual, 4, 0, call);
    }

    fn end_directions(&mut self, number: usize, done: usize) {
        let call = Call {
            number: number as u32,
            axis: done as u32,
            ..Call::default()
        };
        self.add_up(Wanted::Weights, self.summing(4, call));
        let places = u64::from(self.plan.inner(0)) * number as u64 * 4;
        self.each(Stage::AddDirections, 4, call);
        self.bytes += 4 * places;
    }

    /// Removes the divergence of the velocity.
    fn project(&mut self, iterations: usize) {
        if iterations == 0 {
            return;
        }
        let plain = Call::default();
        let numbers = [X, B + 3, LACKING, ANSWER];
        let [x, volume, lacking, answer] = numbers.map(|number| self.plan.field(number));
        let call = Call {
            source: x,
            into: volume,
            ..plain
        };
        self.each(Stage::FindLacking, 1, call);
        self.summed(Stage::WeighLacking, 1, 0, plain);
        self.add_up(Wanted::Mean, self.summing(1, plain));
        self.summed(Stage::LevelLacking, 1, 0, plain);
        let norm = |iteration: usize| Call {
            axis: iteration as u32,
            ..plain
        };
        for iteration in 0..iterations {
            self.cycle([3, 1], lacking, answer);
            self.summed(Stage::MultiplyAnswer, 1, 0, plain);
            self.add_up(Wanted::Turn, self.summing(1, norm(iteration)));
            self.each(Stage::TurnDirection, 1, plain);
            self.summed(Stage::BendDirection, 1, 0, plain);
            self.add_up(Wanted::Reach, self.summing(1, plain));
            self.summed(Stage::FollowDirection, 1, 0, plain);
        }
        self.add_up(Wanted::Turn, self.summing(1, norm(iterations)));
        self.each(Stage::CorrectFlow, 4, plain);
    }

    /// Transports paint along one axis after the other, then lets drops sink.
    fn carry(&mut self) {
        let paints = self.plan.paints.count as u32;
        let take = |is_new: u32, begins: u32| Call {
            first: is_new,
            axis: begins,
            ..Call::default()
        };
        for part in 0..self.plan.paints.parts as u32 {
            for number in 0..3 {
                let begins = u32::from(number == 0);
                let is_new = u32::from(part + number > 0);
                self.each(Stage::TakeCounts, 1, take(is_new, begins));
                let call = Call {
                    mode: part,
                    number,
                    ..Call::default()
                };
                self.each(Stage::AskFaces, 1, call);
                self.each(Stage::ShareFaces, 1, call);
                self.each(Stage::CarryPaint, paints, call);
            }
        }
        self.each(Stage::TakeCounts, 1, take(1, 1));
        self.each(Stage::SettleDrops, paints, Call::default());
        self.each(Stage::TakeCounts, 1, take(1, 1));
    }

    /// A V-cycle of `components` components from `first` on.
    fn cycle(&mut self, [first, components]: [u32; 2], source: u32, into: u32) {
        let rest = self.plan.rest;
        let at = |level: usize, mode| Call {
            level: level as u32,
            first,
            source,
            into,
            mode,
            ..Call::default()
        };
        for level in 0..rest {
            self.inner(level, Stage::BeginCycle, components, at(level, 0));
            self.inner(level, Stage::LeaveResidual, components, at(level, 0));
            self.inner(level + 1, Stage::RestrictResidual, components, at(level, 0));
        }
        let places = u64::from(self.plan.inner(rest) * components);
        self.dispatch(Stage::CycleRest, [1, 1, components], at(rest, 0), places);
        for level in (0..rest).rev() {
            self.inner(level, Stage::ProlongSolution, components, at(level, 0));
            self.inner(level, Stage::RelaxSolution, components, at(level, 0));
            self.inner(level, Stage::RelaxSolution, components, at(level, 1));
        }
    }

    /// Adds a stage on each place of the finest grid's cells.
    fn each(&mut self, stage: Stage, fields: u32, call: Call) {
        self.inner(0, stage, fields, call);
    }

    fn inner(&mut self, level: usize, stage: Stage, fields: u32, call: Call) {
        self.over(self.plan.inner(level), stage, fields, call);
    }

    /// Adds a stage on every place of a level's fields.
    fn all(&mut self, level: usize, stage: Stage, fields: u32, call: Call) {
        self.over(self.plan.levels[level].len, stage, fields, call);
    }

    fn over(&mut self, places: u32, stage: Stage, fields: u32, call: Call) {
        let groups = places.div_ceil(GROUP);
        let rows = groups.div_ceil(ROW);
        let size = [groups.min(ROW), rows, fields];
        self.dispatch(stage, size, call, u64::from(places) * u64::from(fields));
    }

    /// The call of a stage with sums over several components.
    fn summing(&self, components: u32, call: Call) -> Call {
        let groups = (components * self.plan.inner(0)).div_ceil(SUMMED);
        Call { groups, ..call }
    }

    /// Adds a stage with sums; besides its own fields it reads `others` fields of earlier directions.
    fn summed(&mut self, stage: Stage, components: u32, others: u64, call: Call) {
        let call = self.summing(components, call);
        let places = u64::from(components * self.plan.inner(0));
        self.bytes += 4 * places * others;
        self.dispatch(stage, [call.groups, 1, 1], call, places);
    }

    fn add_up(&mut self, wanted: Wanted, call: Call) {
        let call = Call {
            mode: wanted as u32,
            ..call
        };
        self.dispatch(Stage::AddUp, [1, 1, 1], call, u64::from(call.groups));
    }

    fn dispatch(&mut self, stage: Stage, groups: [u32; 3], call: Call, places: u64) {
        self.bytes += 4 * places * KERNELS[stage as usize].words;
        self.dispatches.push(Dispatch {
            stage,
            groups,
            call,
        });
    }
}
