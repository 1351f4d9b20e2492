"""What scenes/report.py makes a page of: problems, and the commands for each."""

import dataclasses
import math
import shlex


@dataclasses.dataclass(frozen=True)
class Problem:
    scene: str
    kind: str  # of scene, in the table at the top
    title: str
    asked: str
    charts: tuple = ("",)  # options of each
    area: str = ""  # options of its map
    tune: str | None = ""  # options; None: its map is the answer
    notes: str = ""
    # Of a map over dt: a product of dt (s) and y that theory knows, and its name.
    product: object = None
    product_name: str = ""
    mapped_substeps: str = "1"


AWAKE = "--set sleep_after=0"
PROBLEMS = [
    Problem("mass_on_spring", "springs", "A mass on a spring",
            "Three masses swing on springs of 0.5, 1 and 2 Hz, and nothing brakes them. How fast does "
            "the error of the place after 2.3 periods fall with dt, and what does a swing cost that "
            "is true in period, height and energy?",
            ("--convergence --expect 'after 2.3 periods' --methods explicit_euler,"
             "semi_implicit_euler,stormer_verlet,velocity_verlet,rk4,backward_euler", ""),
            notes="The first chart is of the methods that are smooth in dt; those that solve "
            "constraints are of first order in springs, but for soft step, which is of second."),
    Problem("spring_limit", "springs, how stiff", "How stiff a spring may be",
            "A spring that nothing brakes, of 1 to 32 Hz: up to which dt does it stay bounded? Theory "
            "(dashed) says ω dt = 2 for the symplectic methods and 2√2 for Runge-Kutta 4.",
            (), "--x dt=1/480..1/15:11log --y spring.coil.frequency=1..32:6log --methods "
            "soft_step,explicit_euler,semi_implicit_euler,velocity_verlet,rk4,backward_euler", None,
            "Explicit Euler is stable at no step: where it holds, energy grew less than 300 times in "
            "5 s. What is bounded need not be true: backward Euler damps, and no step longer than "
            "half a period can follow a swing.",
            lambda dt, y: 2 * math.pi * y * dt, "ω dt"),
    Problem("pendulum", "a joint that swings", "A pendulum",
            "A bob on a rod is let go at 60 degrees. Does it keep its energy, its period and the length "
            "of its rod for 20 s?"),
    Problem("top", "a spinning top", "A spinning top",
            "A top that leans by 30 degrees goes round its tip once in 3.14 s. Does it go round as fast "
            "as the closed form says, for 7 s, and neither sink nor rise?"),
    Problem("heavy_chain", "a chain with a heavy end", "A chain with a heavy end",
            "Ten light links carry a ball a hundred times as heavy. Do the links stay together, and "
            "does the chain swing without losing its energy? The map is of balls of 1 to 1000 kg.",
            area="--x dt=1/240..1/30:4log --y body.weight.mass=1..1000:4log --methods "
            "soft_step,tgs_soft,sequential_impulses,xpbd"),
    Problem("ten_box_stack", "a stack", "A stack",
            "Ten boxes stand on each other. Do they stay where they are, and hardly sink in? The map "
            "is of 5 to 20 boxes; where the tenth is not there, nothing may sink in.",
            (AWAKE,), "--x dt=1/240..1/30:4log --y body.box.repeat.count=5,10,15,20 --methods "
            f"soft_step,tgs_soft,sequential_impulses,nncg {AWAKE}", AWAKE),
    Problem("slope_holds", "friction that holds", "Friction that holds",
            "A box lies on a slope that is just not steep enough for it to slide. Does it stay within "
            "2 mm for 10 s? The map is of other coefficients of friction: 0.49 is what just holds.",
            (AWAKE,), "--x material.wood.friction=0.47..0.53:7 --y dt=1/240..1/30:4log --methods "
            f"soft_step,tgs_soft,sequential_impulses,xpbd {AWAKE}", AWAKE),
    Problem("bounce_half", "restitution", "Restitution",
            "A ball falls and bounces with half its speed each time. Does it come up as high as it "
            "should, twice, and then lie still?",
            (AWAKE,), tune=AWAKE),
    Problem("struck_before_wall", "fast impacts", "Struck before a wall",
            "A ball at rest 10 cm before a wall of 1 cm is struck by one ten times as heavy. Does it "
            "stay on its side? The chart is of 20 m/s, the map of 5 to 80 m/s.",
            ("",), "--x dt=1/480..1/30:9log --y body.heavy.velocity.x=5..80:5log "
            "--methods soft_step,tgs_soft,sequential_impulses", None,
            "What holds at one speed and step may fail at the next, so that the map counts, not the "
            "cheapest dot of the chart.", mapped_substeps="4 to 128"),
    Problem("hanging_cloth", "cloth", "Cloth",
            "Two sheets hang from an edge and from two corners. Does the first stretch under its own "
            "weight as far as the closed form says, does the second hang evenly, and does energy not "
            "grow?",
            ("--sweep substeps=1..8 --repeats 2",),
            tune="--precision float --dt 1/120 --methods "
            "soft_step,semi_implicit_euler,stormer_verlet,velocity_verlet",
            notes="Tuning goes through four methods alone, at the scene's own dt: cloth takes long."),
    Problem("tumbling", "a chaotic heap", "A heap",
            "Twelve crystals and twelve drums fall into a heap. Runs of it part however true they are, "
            "so the chart is of single steps: how far off is each body a sixtieth of a second after "
            "states of one accurate run?",
            (f"--one-step {AWAKE}",), tune=AWAKE),
]
SIMBENCHMARK = "SimBenchmark (Kang, Hwangbo 2018)"
ENZENHOEFER = "Enzenhoefer, Andrews, Teichmann, Kövecses 2018"
DT_SWEEP = ("--sweep dt=1/240..1/30 --repeats 1",)
PROBLEMS += [Problem(scene, kind, title, f"{asked} Here dt is swept. After {source}.", DT_SWEEP, tune=None)
             for source, scene, kind, title, asked in (
    (SIMBENCHMARK, "rolling", "published: rolling", "Rolling on a sled",
     "Balls roll on a sled that is pulled along it and at 45 degrees. Do they go as friction in a "
     "round cone has them?"),
    (SIMBENCHMARK, "bouncing", "published: bouncing", "Bouncing balls",
     "Balls that lose nothing are dropped. Is their energy kept?"),
    (SIMBENCHMARK, "666", "published: a heap of balls", "666",
     "Layers of balls fall into a heap and run apart. Does nothing sink in?"),
    (SIMBENCHMARK, "elastic_666", "published: elastic balls", "Elastic 666",
     "The same of balls that lose nothing. Is their energy kept?"),
    (SIMBENCHMARK, "kapla", "published: a tower", "Kapla tower",
     "A tower of 102 planks: does it stand?"),
    (ENZENHOEFER, "static_stability", "published: leaning stacks", "Static stability",
     "Two stacks lean, at 0.9 and at 1.1 of what statics allows. Does the one stand and the other "
     "fall?"),
    (ENZENHOEFER, "closed_loop", "published: a closed loop", "Closed loop",
     "A bar on two cranks, more constrained than it needs to be: does it swing with its period?"),
    (ENZENHOEFER, "grasping", "published: grasping", "Grasping",
     "Two fingers hold a crate by friction, and two others press too little. Does the one stay and "
     "the other slip?"),
    (ENZENHOEFER, "long_chain", "published: a long chain", "Long chain",
     "A chain of 60 links is let go level. Do its links stay together?"))]
QUICK = "--repeats 1 --sweep substeps=1,4 --methods soft_step,sequential_impulses"


def chart_stem(scene, options):
    kind = [name for name in ("convergence", "one-step") if "--" + name in options]
    return ".".join([scene, *kind])


def commands_of(problem, out="out/report", quick=False):
    """Each of the program's commands for a problem, as a list of its words, from the repository."""
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
