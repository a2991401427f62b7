//! The terms of a surrogate, products of functions of factors, and which of them are candidates.

use std::collections::HashSet;

use super::family::Family;

/// Maximum number of factors in a term of the first candidates.
const MAX_FACTORS: usize = 3;

/// Maximum number of factors in any term.
const MAX_FACTORS_OF_NEIGHBOURS: usize = 5;

/// The norm of hyperbolic truncation: of two terms with equal sums of degrees, the one with fewer factors comes first.
const NORM: f64 = 0.75;

/// Factors that are tried as partners of every term.
const LEADING: usize = 8;

/// Share of the variance below which a factor is not tried as a partner.
const LEADING_SHARE: f64 = 1e-7;

/// A product of polynomials of different factors: (factor, degree) by rising factor, degrees from 1; the empty one is the
/// constant.
pub type Term = Vec<(usize, usize)>;

/// Limits on the number and the degree of candidate terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Caps<'a> {
    /// Maximum number of candidate terms.
    pub terms: usize,
    /// Maximum sum of degrees.
    pub degree: usize,
    /// Maximum sum of the degrees of polynomials without bounds.
    pub unbounded_degree: usize,
    /// The polynomials of every factor.
    pub families: &'a [Family],
}

impl<'a> Caps<'a> {
    /// Returns the limits for factors with polynomials of these `families`.
    pub fn new(families: &'a [Family], unbounded_degree: usize) -> Self {
        let terms = match families.len() {
            0..=4 => 400,
            5..=10 => 300,
            _ => 260,
        };
        let degree = Self::degree_of(families.len());
        Self { terms, degree, unbounded_degree, families }
    }

    /// Returns the largest sum of degrees of a term with this number of factors.
    pub fn degree_of(factors: usize) -> usize {
        match factors {
            0..=4 => 14,
            5..=10 => 10,
            _ => 6,
        }
    }

    /// Returns whether the degree of `term` is within the limits.
    fn allow(&self, term: &[(usize, usize)]) -> bool {
        let (mut sum, mut unbounded_sum) = (0, 0);
        for &(factor, degree) in term {
            let family = &self.families[factor];
            if degree > family.degree() {
                return false;
            }
            sum += degree;
            unbounded_sum += if family.is_unbounded() { degree } else { 0 };
        }
        sum <= self.degree && unbounded_sum <= self.unbounded_degree
    }
}

/// Returns the first `count` terms by the hyperbolic norm of their degrees, the constant first.
pub fn first_terms(caps: Caps<'_>, count: usize) -> Vec<Term> {
    let (factors, degree) = (caps.families.len(), caps.degree);
    let mut patterns: Vec<(f64, Vec<usize>)> = Vec::new();
    for members in 1..=MAX_FACTORS.min(factors) {
        // Rising degrees, to be assigned to factors in every way.
        let most = match members {
            1 => degree,
            2 => degree.min(7),
            _ => degree.min(5),
        };
        rising(members, most, &mut Vec::new(), &mut |degrees| {
            let norm = libm::pow(degrees.iter().map(|&k| libm::pow(k as f64, NORM)).sum(), 1.0 / NORM);
            patterns.push(((norm * 1e9).round(), degrees.to_vec()));
        });
    }
    patterns.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.len().cmp(&b.1.len())).then(a.1.cmp(&b.1)));
    let mut terms: Vec<Term> = vec![Vec::new()];
    for (_, degrees) in patterns {
        let deals = permutations(&degrees);
        let mut members: Vec<usize> = (0..degrees.len()).collect();
        loop {
            for deal in &deals {
                if terms.len() >= count {
                    return terms;
                }
                let term: Term = members.iter().copied().zip(deal.iter().copied()).collect();
                if caps.allow(&term) {
                    terms.push(term);
                }
            }
            if !next_members(&mut members, factors) {
                break;
            }
        }
    }
    terms
}

/// Calls `visit` with every list of `members` rising degrees whose sum is at most `most`.
fn rising(members: usize, most: usize, so_far: &mut Vec<usize>, visit: &mut dyn FnMut(&[usize])) {
    if so_far.len() == members {
        visit(so_far);
        return;
    }
    let least = so_far.last().copied().unwrap_or(1);
    let left = members - so_far.len();
    for degree in least..=most / left {
        so_far.push(degree);
        rising(members, most - degree, so_far, visit);
        so_far.pop();
    }
}

/// Returns the distinct permutations of `degrees`.
fn permutations(degrees: &[usize]) -> Vec<Vec<usize>> {
    if degrees.len() <= 1 {
        return vec![degrees.to_vec()];
    }
    let mut all = Vec::new();
    for (place, &first) in degrees.iter().enumerate() {
        let mut rest = degrees.to_vec();
        rest.remove(place);
        for order in permutations(&rest) {
            let order: Vec<usize> = std::iter::once(first).chain(order).collect();
            if !all.contains(&order) {
                all.push(order);
            }
        }
    }
    all
}

/// Advances to the next choice of rising members below `factors`; returns `false` after the last one.
fn next_members(members: &mut [usize], factors: usize) -> bool {
    let count = members.len();
    for place in (0..count).rev() {
        if members[place] < factors - (count - place) {
            members[place] += 1;
            for later in place + 1..count {
                members[later] = members[later - 1] + 1;
            }
            return true;
        }
    }
    false
}

/// Returns the terms `active` by falling square of their coefficients, and then, for each in this order, its
/// neighbours: with one and two degrees more in one of its factors, and with one of the leading factors as a partner.
pub fn neighbours(active: &[Term], coefficients: &[f64], caps: Caps<'_>) -> Vec<Term> {
    let mut order: Vec<usize> = (0..active.len()).collect();
    order.sort_by(|&i, &j| {
        (coefficients[j] * coefficients[j]).total_cmp(&(coefficients[i] * coefficients[i])).then(i.cmp(&j))
    });
    let mut terms: Vec<Term> = vec![Vec::new()];
    terms.extend(order.iter().map(|&place| active[place].clone()));
    let leading = leading_factors(active, coefficients, &order);
    for term in order.iter().map(|&place| &active[place]).filter(|term| !term.is_empty()) {
        for member in 0..term.len() {
            for more in 1..=2 {
                let mut next = term.clone();
                next[member].1 += more;
                terms.push(next);
            }
        }
        for &factor in &leading {
            if term.len() < MAX_FACTORS_OF_NEIGHBOURS
                && let Err(place) = term.binary_search_by_key(&factor, |(factor, _)| *factor)
            {
                let mut next = term.clone();
                next.insert(place, (factor, 1));
                terms.push(next);
            }
        }
    }
    let mut seen = HashSet::new();
    terms.retain(|term| caps.allow(term) && seen.insert(term.clone()));
    terms.truncate(caps.terms);
    terms
}

/// Adds `more` to the number of `key` in `list`, which has its keys in the order in which they came.
pub(crate) fn add_to<K: PartialEq>(list: &mut Vec<(K, f64)>, key: K, more: f64) {
    match list.iter_mut().find(|(other, _)| *other == key) {
        Some((_, sum)) => *sum += more,
        None => list.push((key, more)),
    }
}

/// Returns the factors whose terms have the most variance, in falling order.
fn leading_factors(active: &[Term], coefficients: &[f64], order: &[usize]) -> Vec<usize> {
    let mut variances: Vec<(usize, f64)> = Vec::new();
    for &place in order {
        for (factor, _) in &active[place] {
            add_to(&mut variances, *factor, coefficients[place] * coefficients[place]);
        }
    }
    let all: f64 = variances.iter().map(|(_, variance)| variance).sum();
    variances.retain(|(_, variance)| *variance > LEADING_SHARE * all);
    variances.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    variances.truncate(LEADING);
    variances.into_iter().map(|(factor, _)| factor).collect()
}

#[cfg(test)]
mod tests;
