"""The problems on the page of scenes/report.py, and the commands for each."""

import dataclasses
import math
import shlex


@dataclasses.dataclass(frozen=True)
class Problem:
    scene: str
    kind: str  # of scene, in the table at the top
    title: str
    asked: str
    charts: tuple = ("",)  # the options of each
    area: str = ""  # the map's options
    tune: str | None = ""  # options; None: the map or, without one, the chart is the answer
    notes: str = ""
    # For a map over dt: a product of dt (s) and y whose limit is known in theory, and its name.
    product: object = None
    product_name: str = ""
    mapped_substeps: str = "1"


AWAKE = "--set sleep_after=0"
PROBLEMS = [
    Problem("mass_on_spring", "springs", "A mass on a spring",
            "Three masses oscillate on undamped springs of 0.5, 1 and 2 Hz. How fast does the position "
            "error after 2.3 periods fall with dt, and what does it cost to get period, height and "
            "energy right?",
            ("--convergence --expect 'after 2.3 periods' --methods explicit_euler,"
             "semi_implicit_euler,stormer_verlet,velocity_verlet,rk4,backward_euler", ""),
            notes="The first chart shows the methods whose error is smooth in dt; constraint solvers "
            "are first order for springs, except soft step, which is second order."),
    Problem("spring_limit", "spring stiffness", "Stability limit of a spring",
            "An undamped spring of 1 to 32 Hz: up to which dt does it stay bounded? Theory (dashed) "
            "predicts ω dt = 2 for the symplectic methods and 2√2 for Runge-Kutta 4.",
            (), "--x dt=1/480..1/15:11log --y spring.coil.frequency=1..32:6log --methods "
            "soft_step,explicit_euler,semi_implicit_euler,velocity_verlet,rk4,backward_euler", None,
            "Explicit Euler is never stable: its energy grows by exp(ω² dt t). Bounded does not mean "
            "accurate: backward Euler damps, and no dt above half a period can resolve the oscillation.",
            lambda dt, y: 2 * math.pi * y * dt, "ω dt"),
    Problem("pendulum", "a swinging joint", "A pendulum",
            "A bob on a rod is released at 60 degrees. Are its energy, period and rod length right for "
            "20 s?"),
    Problem("top", "a spinning top", "A spinning top",
            "A top leaning by 30 degrees precesses with a period of 3.14 s. Does it keep this "
            "closed-form period for 7 s, without sinking or rising?"),
    Problem("heavy_chain", "a chain with a heavy end", "A chain with a heavy end",
            "Ten light links carry a ball a hundred times as heavy as each. Do the joints hold, and "
            "is energy conserved as the chain swings? The map covers balls of 1 to 1000 kg.",
            area="--x dt=1/240..1/30:4log --y body.weight.mass=1..1000:4log --methods "
            "soft_step,tgs_soft,sequential_impulses,xpbd"),
    Problem("ten_box_stack", "a stack", "A stack",
            "Ten stacked boxes. Do they stay in place, with little penetration? The map covers 5 to 20 "
            "boxes; with fewer than ten, the scene only limits penetration.",
            (AWAKE,), "--x dt=1/240..1/30:4log --y body.box.repeat.count=5,10,15,20 --methods "
            f"soft_step,tgs_soft,sequential_impulses,nncg {AWAKE}", AWAKE),
    Problem("slope_holds", "static friction", "Static friction",
            "A box rests on a slope just below the friction angle. Does it stay within 2 mm for 10 s? "
            "The map varies the coefficient of friction from just above the critical 0.490.",
            (AWAKE,), "--x material.wood.friction=0.492..0.53:7 --y dt=1/240..1/30:4log --methods "
            f"soft_step,tgs_soft,sequential_impulses,xpbd {AWAKE}", AWAKE),
    Problem("bounce_half", "restitution", "Restitution",
            "A ball falls and rebounds at half its speed each time. Are the first two bounces as high "
            "as they should be, and does it then come to rest?",
            (AWAKE,), tune=AWAKE),
    Problem("struck_before_wall", "fast impacts", "A ball knocked into a wall",
            "A ball at rest 10 cm from a wall 1 cm thick is hit by one ten times as heavy. Does it "
            "stay on its side? The chart is for 20 m/s, the map covers 5 to 80 m/s.",
            ("",), "--x dt=1/480..1/30:9log --y body.heavy.velocity.x=5..80:5log "
            "--methods soft_step,tgs_soft,sequential_impulses", None,
            "What holds at one speed and dt may fail at the next, so the map decides, not the "
            "cheapest dot on the chart.", mapped_substeps="4 to 128"),
    Problem("hanging_cloth", "cloth", "Cloth",
            "One sheet hangs by an edge, another by two corners. Does the first stretch under its own "
            "weight as the closed form predicts, does the second hang evenly, and is no energy gained?",
            ("--sweep substeps=1..8 --repeats 2",),
            tune="--precision float --dt 1/120 --methods "
            "soft_step,semi_implicit_euler,stormer_verlet,velocity_verlet",
            notes="Tuning covers only four methods, at the scene's own dt in float: cloth is slow."),
    Problem("tumbling", "a chaotic heap", "A heap",
            "Twelve crystals and twelve drums fall into a heap. Runs diverge however accurate they are, "
            "so the chart shows single steps: how far off are the bodies 1/60 s after states taken "
            "from one accurate run? That run is by soft_step, in double with 64 steps of 4 substeps, so its "
            "own contact model has the advantage.",
            (f"--one-step {AWAKE}",), tune=AWAKE),
]
SIMBENCHMARK = "SimBenchmark (Kang, Hwangbo 2018)"
ENZENHOEFER = "Enzenhoefer, Andrews, Teichmann, Kövecses 2018"
DT_SWEEP = ("--sweep dt=1/240..1/30 --repeats 1",)
PROBLEMS += [Problem(scene, kind, title, f"{asked} The chart sweeps dt. After {source}.", DT_SWEEP,
                     tune=None)
             for source, scene, kind, title, asked in (
    (SIMBENCHMARK, "rolling", "published: rolling", "Rolling on a sled",
     "Balls roll on sleds pulled along an axis and at 45 degrees. Do they move as a circular "
     "friction cone predicts?"),
    (SIMBENCHMARK, "bouncing", "published: bouncing", "Bouncing balls",
     "Perfectly elastic balls are dropped. Is energy conserved?"),
    (SIMBENCHMARK, "666", "published: a heap of balls", "666",
     "Layers of balls fall into a heap and spread out. Does penetration stay small?"),
    (SIMBENCHMARK, "elastic_666", "published: elastic balls", "Elastic 666",
     "The same with perfectly elastic balls. Is energy conserved?"),
    (SIMBENCHMARK, "kapla", "published: a tower", "Kapla tower",
     "Does a tower of 102 planks stay up?"),
    (ENZENHOEFER, "static_stability", "published: leaning stacks", "Static stability",
     "Two stacks lean by 0.9 and 1.1 times the static limit. Does the first stay up, and the second "
     "fall?"),
    (ENZENHOEFER, "closed_loop", "published: a closed loop", "Closed loop",
     "A bar on two cranks forms an overconstrained loop. Does it swing with the right period?"),
    (ENZENHOEFER, "grasping", "published: grasping", "Grasping",
     "Two fingers hold a crate by friction; two others press too weakly. Does the first crate stay, "
     "and the second slip?"),
    (ENZENHOEFER, "long_chain", "published: a long chain", "Long chain",
     "A horizontal chain of 60 links, fixed at one end, is released. Do its joints hold?"))]
QUICK = "--repeats 1 --sweep substeps=1,4 --methods soft_step,sequential_impulses"


def chart_stem(scene, options):
    kind = [name for name in ("convergence", "one-step") if "--" + name in options]
    return ".".join([scene, *kind])


def commands_of(problem, out="out/report", quick=False):
    """The program's commands for a problem, each a list of words, to be run from the repository."""
    commands = []
    for chart in problem.charts[:1] if quick else problem.charts:
        options = shlex.split(chart)
        if quick:
            kind = [name for name in ("--convergence", "--one-step") if name in options]
            sweep = "--sweep dt=1/240..1/60" if "--convergence" in kind else QUICK
            options = kind + shlex.split(sweep)
        commands.append(["chart", problem.scene, *options, "--out", out])
    if problem.area and not quick:
        commands.append(["map", problem.scene, *shlex.split(problem.area), "--image",
                         f"{out}/{problem.scene}.map.png", "--csv",
                         f"{out}/{problem.scene}.map.csv"])
    if problem.tune is not None and not quick:
        commands.append(["tune", problem.scene, *shlex.split(problem.tune)])
    return commands


def in_words(command):
    return "./plumb " + shlex.join(command)
