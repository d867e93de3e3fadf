# YADE on both works of ../dem-peers.sh:  yade -n -x -j THREADS yade_work.py WORK FILE STEPS SKIN_RATIO
# Numbers common to all programs come from the environment (KN KT_KN MU DT WIDTH SPEED DENSITY).
# Springs are those of the others (kn and kt given, not from a modulus). Law2_ScGeom_FrictPhys_CundallStrack has no
# dashpots, so YADE has less to compute; its own local damping takes their place.
import os
import sys
import time

work, name, steps, verlet = sys.argv[1], sys.argv[2], int(sys.argv[3]), float(sys.argv[4])
value = {key: float(os.environ[key]) for key in ("KN", "KT_KN", "MU", "DT", "WIDTH", "SPEED", "DENSITY")}
plane = work == "plate"

material = FrictMat(density=value["DENSITY"], young=1e9, poisson=0.3, frictionAngle=atan(value["MU"]))
O.materials.append(material)
radius = 0.0
for line in open(name):
    x, y, z, r, driven = line.split()
    radius = float(r)
    body = sphere((float(x), float(y), float(z)), radius, material=material, fixed=driven == "1")
    if plane:
        # The mass of a disc of thickness 1 m; it moves in the plane.
        body.state.mass = value["DENSITY"] * pi * radius**2
        body.state.inertia = Vector3(1, 1, 1) * 0.5 * body.state.mass * radius**2
        body.state.blockedDOFs = "zXY" if driven == "0" else "xyzXYZ"
    if driven == "1":
        body.state.vel = Vector3(0, value["SPEED"], 0)
    O.bodies.append(body)
walls = [(0.0, 0), (value["WIDTH"], 0), (0.0, 1)]
if not plane:
    walls += [(value["WIDTH"], 1), (0.0, 2)]
for place, axis in walls:
    O.bodies.append(utils.wall(place, axis=axis, material=material))

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=verlet * radius),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_FrictPhys(kn=MatchMaker(algo="val", val=value["KN"]),
                                         ks=MatchMaker(algo="val", val=value["KN"] * value["KT_KN"]))],
        [Law2_ScGeom_FrictPhys_CundallStrack()],
    ),
    NewtonIntegrator(damping=0.2, gravity=(0, -9.81, 0) if plane else (0, 0, -9.81)),
]
O.dt = value["DT"]
O.run(10, True)  # the first sort belongs to the set-up
start = time.perf_counter()
O.run(steps, True)
seconds = time.perf_counter() - start
print("YADE %d bodies %d steps %.6f s, kinetic energy %.9g J, %d contacts" % (
    len(O.bodies), steps, seconds, utils.kineticEnergy(), O.interactions.countReal()))
