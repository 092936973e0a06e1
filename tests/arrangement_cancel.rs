//! Cancelling: whenever the caller wants it, each stage notices soon and leaves nothing behind. Threads do not matter to the bits. Deep input needs
//! no stack. `LAPIDARY_LONG=1` for larger input.

use lapidary::arrangement::certify::{CertifyOptions, certify};
use lapidary::arrangement::volumes::six_volume_residue;
use lapidary::arrangement::{Arrangement, ArrangementOptions, Selection, arrange, choose, extract};
use lapidary::base::{Run, Status};
use lapidary::exact::Residue;
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::{Duration, Instant};

#[path = "common/mod.rs"]
mod common;
#[path = "common/solid_oracle.rs"]
mod solid_oracle;
use common::random::Random;
use common::shapes::{geodesic, grid_cube, moved, rotation, shifted};
use common::{Soup, cuboid, together};
use solid_oracle::{operands, six_volume};

/// Bytes that are mapped, for large arrays, and bytes that the system's allocator has given out.
fn held() -> [i64; 2] {
    let pages = std::fs::read_to_string("/proc/self/statm").expect("a file of the system's");
    let pages: i64 = pages.split(' ').next().and_then(|n| n.parse().ok()).expect("a number");
    // SAFETY: asks for a few numbers.
    let small = unsafe { libc::mallinfo2() };
    [pages * 4096, (small.uordblks + small.hblkhd) as i64]
}

/// One test at a time: bytes and times are everybody's.
static ALONE: Mutex<()> = Mutex::new(());

fn alone() -> std::sync::MutexGuard<'static, ()> {
    ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn long() -> bool {
    std::env::var_os("LAPIDARY_LONG").is_some()
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
}

/// Two spheres of 200 000 triangles each.
fn spheres() -> Vec<Soup> {
    let ball = geodesic(100);
    vec![ball.clone(), moved(&ball, rotation(&mut Random(3)), 1.0, [0.5, 0.4, 0.3])]
}

/// Two cubes with many squares a side, on one another: two clusters with tens of thousands of triangles each.
fn coplanar(n: i32) -> Vec<Soup> {
    let a = grid_cube(n, [0.0; 3], 1.0);
    let turn = [[1.0, 8.0, 4.0], [8.0, 1.0, -4.0], [-4.0, 4.0, -7.0]];
    [a.clone(), shifted(&a, [0.5, 0.25, 0.0])].map(|s| moved(&s, turn, 1.0, [0.0; 3])).into()
}

/// Long triangles through one another: every one meets every other one, and each holds thousands of segments.
fn needles(n: usize) -> Vec<Soup> {
    let mut random = Random(5);
    let needle = |random: &mut Random| {
        let turn = rotation(random);
        moved(
            &cuboid([-1.0, -0.25, -0.01], [1.0, 0.25, 0.01]),
            turn,
            1.0,
            std::array::from_fn(|_| 0.1 * random.signed()),
        )
    };
    vec![together(&(0..n).map(|_| needle(&mut random)).collect::<Vec<_>>())]
}

fn make(soups: &[Soup], run: &mut Run) -> lapidary::base::Result<Arrangement> {
    arrange(&operands(&soups.iter().collect::<Vec<_>>()), &ArrangementOptions::default(), run)
}

/// The whole way: an arrangement, the union, and that certified.
fn certified_union(soups: &[Soup], run: &mut Run) -> lapidary::base::Result<usize> {
    let a = make(soups, run)?;
    let e = extract(&a, &choose(&a, Selection::Union)?)?;
    drop(a);
    Ok(certify(&e.coords, &e.triangles, &CertifyOptions::default(), run)?.triangles.len())
}

/// The longest time between two questions, by what the first of them named; the last one until the result is there.
fn longest_silence<T>(
    threads: usize,
    work: impl Fn(&mut Run) -> lapidary::base::Result<T> + Sync,
) -> BTreeMap<&'static str, Duration> {
    let mut gaps: BTreeMap<&'static str, Duration> = BTreeMap::new();
    let mut last: (&'static str, Instant) = ("start", Instant::now());
    let mut progress = |name: &'static str, fraction: f64| {
        assert!((0.0..=1.0).contains(&fraction));
        let gap = gaps.entry(last.0).or_default();
        *gap = last.1.elapsed().max(*gap);
        last = (name, Instant::now());
        true
    };
    let outcome = pool(threads).install(|| work(&mut Run::new(Some(&mut progress), None)).map(drop));
    outcome.unwrap();
    let gap = gaps.entry(last.0).or_default();
    *gap = last.1.elapsed().max(*gap);
    gaps
}

/// Cancels at `points` moments spread over the run: the longest time from the request to the return.
fn cancel_everywhere<T>(
    what: &str,
    threads: usize,
    points: u32,
    work: impl Fn(&mut Run) -> lapidary::base::Result<T> + Sync,
) -> Duration {
    let pool = pool(threads);
    let started = Instant::now();
    pool.install(|| work(&mut Run::quiet()).map(drop)).unwrap();
    let whole = started.elapsed();
    let mut worst = (Duration::ZERO, String::new());
    let mut stages: BTreeMap<String, u32> = BTreeMap::new();
    let mut before = [0; 2];
    for k in 0..points {
        let at = whole * k / points;
        let started = Instant::now();
        // Asked before the request is due it says to go on, and after that at once to stop.
        let mut asked_after = 0;
        let mut progress = |_: &'static str, _: f64| {
            assert_eq!(asked_after, 0, "asked again after the answer was to stop");
            asked_after += (started.elapsed() >= at) as u32;
            asked_after == 0
        };
        let outcome = pool.install(|| work(&mut Run::new(Some(&mut progress), None)).map(drop));
        let late = started.elapsed().saturating_sub(at);
        match outcome {
            Ok(()) => *stages.entry("none: it was done".into()).or_default() += 1,
            Err(error) => {
                assert_eq!(error.status, Status::Cancelled, "{}", error.message);
                *stages.entry(error.message.clone()).or_default() += 1;
                if late > worst.0 {
                    worst = (late, error.message);
                }
            }
        }
        // The first ones fill what threads keep for themselves. After that nothing is left behind, however often: an array of any stage would show.
        if k == points / 3 {
            before = held();
        }
    }
    let after = held();
    for i in 0..2 {
        assert!(after[i] - before[i] < 1 << 20, "{what}: from {before:?} to {after:?} bytes");
    }
    println!("{what}, {threads} threads: {whole:?} in all; longest from request to return {:?} ({})", worst.0, worst.1);
    stages.iter().for_each(|(s, n)| println!("    {n} times {s}"));
    worst.0
}

/// A tenth of a second in a release build; more for slow builds and machines that are busy, where the clock tells of others.
fn limit() -> Duration {
    Duration::from_millis(if cfg!(debug_assertions) { 2000 } else { 100 })
}

/// Times depend on who else is at work, so the best of some tries counts.
fn within_limit(what: &str, mut measure: impl FnMut() -> Duration) {
    let mut best = Duration::MAX;
    for _ in 0..3 {
        best = best.min(measure());
        if best <= limit() {
            return;
        }
    }
    panic!("{what}: {best:?} from the request to the return");
}

#[test]
fn every_stage_asks_often() {
    let _alone = alone();
    let inputs = [
        ("two spheres", spheres()),
        ("coplanar squares", coplanar(if long() { 200 } else { 40 })),
        ("needles", needles(if long() { 32 } else { 20 })),
    ];
    for (what, soups) in &inputs {
        for threads in [1, 2] {
            within_limit(what, || {
                let gaps = longest_silence(threads, |run| certified_union(soups, run));
                println!("{what}, {threads} threads: longest time without a question, after which it is {gaps:?}");
                gaps.values().copied().max().unwrap()
            });
        }
    }
}

#[test]
fn cancelled_anywhere_it_returns_soon_and_frees_all() {
    let _alone = alone();
    let points = if long() { 200 } else { 9 };
    let (balls, squares) = (spheres(), coplanar(40));
    for threads in [1, 2] {
        within_limit("spheres", || cancel_everywhere("two spheres", threads, points, |run| make(&balls, run)));
        within_limit("squares", || {
            cancel_everywhere("coplanar squares", threads, points, |run| certified_union(&squares, run))
        });
    }
}

/// Every answer of a run may be the one to stop.
#[test]
fn every_question_may_be_the_last() {
    let _alone = alone();
    let soups = coplanar(2);
    // How often it asks depends on time as well, so the last one is not known before.
    for stop in 0.. {
        let mut asked = 0;
        let mut progress = |_: &'static str, _: f64| {
            asked += 1;
            asked <= stop
        };
        match certified_union(&soups, &mut Run::new(Some(&mut progress), None)) {
            Err(error) => assert_eq!((error.status, asked), (Status::Cancelled, stop + 1)),
            Ok(_) => {
                assert!(asked <= stop && stop > 20, "{asked} questions, none of which was answered");
                return;
            }
        }
    }
}

/// All that a run makes, bit by bit.
fn bits(soups: &[Soup], threads: usize) -> (Vec<u64>, String) {
    pool(threads).install(|| {
        let a = make(soups, &mut Run::quiet()).unwrap();
        let e = extract(&a, &choose(&a, Selection::Union).unwrap()).unwrap();
        let c = certify(&e.coords, &e.triangles, &CertifyOptions::default(), &mut Run::quiet()).unwrap();
        let r = &a.resolved;
        let coords = r.points.coords.iter().chain(&e.coords).chain(&c.coords).flatten().map(|x| x.to_bits()).collect();
        let mut text = format!("{:?} {:?} {:?} {:?}", r.faces, r.support, r.points.origins, r.births);
        text += &format!("{:?} {:?} {e:?} {:?} {:?}", a.cells, a.winding, c.triangles, c.report);
        (coords, text)
    })
}

#[test]
fn threads_do_not_matter() {
    let _alone = alone();
    let ball = geodesic(if long() { 100 } else { 30 });
    let two = vec![ball.clone(), moved(&ball, rotation(&mut Random(3)), 1.0, [0.5, 0.4, 0.3])];
    for (what, soups) in [("spheres", two), ("squares", coplanar(12)), ("needles", needles(10))] {
        let one = bits(&soups, 1);
        for threads in [2, 8] {
            assert!(bits(&soups, threads) == one, "{what}: {threads} threads");
        }
    }
}

/// A bar along x, 1 × 1 across, with `n` squares a side.
fn bar(n: i32) -> Soup {
    let mut s = Soup::default();
    for i in 0..=n {
        s.vertices.extend([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[y, z]| [f64::from(i), y, z]));
    }
    let mut quad = |[a, b, c, d]: [i32; 4]| s.triangles.extend([[a, b, c], [a, c, d]]);
    for i in 0..n {
        for k in 0..4 {
            let (a, b) = (4 * i + k, 4 * i + (k + 1) % 4);
            quad([a, b, b + 4, a + 4]);
        }
    }
    quad([3, 2, 1, 0]);
    quad([4 * n, 4 * n + 1, 4 * n + 2, 4 * n + 3]);
    s
}

/// Deep in every sense: bars on one another whose sides are clusters of one long row; boxes of which each overlaps the next; boxes within boxes;
/// and an expression of as many brackets. On a thread with a stack as small as C libraries give.
#[test]
fn deep_input_needs_no_stack() {
    let _alone = alone();
    let n: i32 =
        std::env::var("BARN").ok().and_then(|n| n.parse().ok()).unwrap_or(if long() { 100_000 } else { 4_000 });
    let small = rayon::ThreadPoolBuilder::new().num_threads(1).stack_size(256 << 10).build().unwrap();
    let six = |a: &Arrangement, s: Selection| {
        let e = extract(a, &choose(a, s).unwrap()).unwrap();
        six_volume_residue(a, &e).unwrap()
    };
    let whole = |x: i64| Residue::from_i64(x);
    small.install(|| {
        let started = Instant::now();
        let one = bar(n);
        assert!(six_volume(&one) == whole(6 * i64::from(n)));
        let a = make(&[one.clone(), shifted(&one, [0.5, 0.0, 0.0])], &mut Run::quiet()).unwrap();
        assert_eq!(a.cell_count(), 4);
        assert!(six(&a, Selection::Union) == whole(6 * i64::from(n) + 3));
        assert!(six(&a, Selection::SymmetricDifference) == whole(6));
        println!("bars: {:?}", started.elapsed());

        let started = Instant::now();
        let link = |i: i32| {
            cuboid(
                [f64::from(i), 0.25 * f64::from(i % 2), 0.0],
                [f64::from(i) + 1.5, 2.0, 1.0 + 0.5 * f64::from(i % 2)],
            )
        };
        let chain = together(&(0..n).map(link).collect::<Vec<_>>());
        let a = make(std::slice::from_ref(&chain), &mut Run::quiet()).unwrap();
        // Each on its own, and what it has in common with the next one.
        let twice: Vec<bool> = (0..a.cell_count()).map(|c| solid_oracle::dense(&a, c) == [2]).collect();
        assert_eq!(twice.iter().filter(|t| **t).count(), n as usize - 1);
        assert!(six(&a, Selection::Resolve) + six(&a, Selection::Table(&twice)) == six_volume(&chain));
        println!("chain: {:?}", started.elapsed());

        let started = Instant::now();
        let nest = |i: i32| cuboid([f64::from(i); 3], [f64::from(4 * n - i); 3]);
        let all = together(&(0..n).map(nest).collect::<Vec<_>>());
        let a = make(&[all], &mut Run::quiet()).unwrap();
        assert_eq!(a.cell_count(), n as usize + 1);
        let deepest = (0..a.cell_count()).map(|c| solid_oracle::dense(&a, c)[0]).max();
        assert_eq!(deepest, Some(n));
        println!("nest: {:?}", started.elapsed());

        let n = n as usize;
        let text = format!("{}0{}", "!(".repeat(2 * n), ")".repeat(2 * n));
        assert!(six(&a, Selection::Expression(&text)) == six(&a, Selection::Union));
    });
}
