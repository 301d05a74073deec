//! In which order the blocks of one sample can be evaluated, found on the entries of S that
//! pass a signal on without delay.

use super::interconnection::Interconnection;
use super::{Block, Sink, Source};

/// Something that is evaluated at once.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Part {
    /// f_base of a block: outputs 0..n_x of w.
    Next(usize),
    /// One output of h_base of a block, by its number in w.
    Readout(usize, usize),
    /// A network.
    Network(usize),
    /// An output ŷ of the whole model, and with it its error.
    Output(usize),
}

/// Parts with what each waits for.
pub(crate) struct Graph {
    pub parts: Vec<Part>,
    /// For each part the parts it needs, and by way of which signals.
    needs: Vec<Vec<(usize, String)>>,
}

/// One step of an order: a part that is ready, or parts that wait for each other.
pub(crate) type Group = Vec<usize>;

impl Graph {
    /// The parts of a model and their dependencies.
    pub fn new(model: &Interconnection) -> Self {
        let mut parts = vec![];
        for (b, block) in model.blocks.iter().enumerate() {
            match block {
                Block::Network(_) => parts.push(Part::Network(b)),
                Block::Baseline(baseline) => {
                    parts.push(Part::Next(b));
                    let n = baseline.sizes();
                    parts.extend((n.x..n.x + n.y).map(|i| Part::Readout(b, i)));
                }
            }
        }
        parts.extend((0..model.outputs).map(Part::Output));
        let mut graph = Self { needs: vec![], parts };
        graph.needs = (0..graph.parts.len()).map(|p| graph.needs_of(model, p)).collect();
        graph
    }

    /// The rows of S that a part looks at.
    pub fn rows(model: &Interconnection, part: &Part) -> Vec<Sink> {
        match *part {
            Part::Next(b) | Part::Network(b) => {
                (0..model.blocks[b].inputs()).map(|i| Sink::Block(b, i)).collect()
            }
            Part::Readout(b, i) => match &model.blocks[b] {
                Block::Baseline(baseline) => {
                    let seen = baseline.looks_at(i - baseline.sizes().x);
                    seen.into_iter().map(|i| Sink::Block(b, i)).collect()
                }
                Block::Network(_) => vec![],
            },
            Part::Output(i) => vec![Sink::Output(i)],
        }
    }

    fn needs_of(&self, model: &Interconnection, part: usize) -> Vec<(usize, String)> {
        let mut needs = vec![];
        for sink in Self::rows(model, &self.parts[part]) {
            for (source, _) in model.s.row(sink) {
                if let Some(giver) = self.giver(model, source) {
                    needs.push((giver, format!("{source} -> {sink}")));
                }
            }
        }
        needs
    }

    /// The part that gives a signal, if any does.
    fn giver(&self, model: &Interconnection, source: Source) -> Option<usize> {
        let wanted = match source {
            Source::Error(i) => Part::Output(i),
            Source::Block(b, i) => match &model.blocks[b] {
                Block::Network(_) => Part::Network(b),
                Block::Baseline(baseline) if i < baseline.sizes().x => Part::Next(b),
                Block::Baseline(_) => Part::Readout(b, i),
            },
            Source::State(_) | Source::Input(_) => return None,
        };
        self.parts.iter().position(|part| *part == wanted)
    }

    /// Groups in the order of evaluation: strongly connected components, by Tarjan's method
    /// (SIAM J. Comput. 1, 1972), which gives them after everything they need.
    pub fn order(&self) -> Vec<Group> {
        let n = self.parts.len();
        let mut search = Search {
            graph: self,
            index: vec![None; n],
            low: vec![0; n],
            on_stack: vec![false; n],
            stack: vec![],
            next: 0,
            groups: vec![],
        };
        for part in 0..n {
            if search.index[part].is_none() {
                search.visit(part);
            }
        }
        search.groups
    }

    /// Whether the parts of a group really wait for each other.
    pub fn is_loop(&self, group: &Group) -> bool {
        group.len() > 1 || self.needs[group[0]].iter().any(|(other, _)| *other == group[0])
    }

    /// The signals along a loop through a group.
    pub fn path(&self, group: &Group) -> Vec<String> {
        // walk from part to part inside the group until one is met again
        let (mut walk, mut at) = (vec![], group[0]);
        loop {
            if let Some(start) = walk.iter().position(|(part, _)| *part == at) {
                let mut path: Vec<String> = walk[start..]
                    .iter()
                    .rev()
                    .map(|(_, way): &(usize, String)| way.clone())
                    .collect();
                path.extend(path.first().cloned());
                return path;
            }
            let Some((next, way)) = self.needs[at].iter().find(|(next, _)| group.contains(next))
            else {
                return vec![];
            };
            walk.push((at, way.clone()));
            at = *next;
        }
    }
}

impl Interconnection {
    /// The loops of S without a state in them, each as the signals along it; such a model is
    /// solved by Newton's method in every sample.
    pub fn algebraic_loops(&self) -> Vec<Vec<String>> {
        let graph = Graph::new(self);
        let loops = graph.order().into_iter().filter(|group| graph.is_loop(group));
        loops.map(|group| graph.path(&group)).collect()
    }
}

/// State of Tarjan's search.
struct Search<'a> {
    graph: &'a Graph,
    index: Vec<Option<usize>>,
    low: Vec<usize>,
    on_stack: Vec<bool>,
    stack: Vec<usize>,
    next: usize,
    groups: Vec<Group>,
}

impl Search<'_> {
    fn visit(&mut self, part: usize) {
        self.index[part] = Some(self.next);
        self.low[part] = self.next;
        self.next += 1;
        self.stack.push(part);
        self.on_stack[part] = true;
        for &(other, _) in &self.graph.needs[part] {
            match self.index[other] {
                None => {
                    self.visit(other);
                    self.low[part] = self.low[part].min(self.low[other]);
                }
                Some(index) if self.on_stack[other] => {
                    self.low[part] = self.low[part].min(index);
                }
                Some(_) => {}
            }
        }
        if Some(self.low[part]) == self.index[part] {
            let mut group = vec![];
            while let Some(other) = self.stack.pop() {
                self.on_stack[other] = false;
                group.push(other);
                if other == part {
                    break;
                }
            }
            group.sort_unstable();
            self.groups.push(group);
        }
    }
}
