# Aligns two clouds with small_gicp, the same way `rounds` times: small_gicp_bench.py FOLDER VOXEL_M ROUNDS, where FOLDER has
# source.f64 and target.f64 (x, y, z of each point) and guess.f64 (16 numbers, row by row). Prints JSON.
import json, os, sys, time
import numpy, small_gicp

folder, voxel_m, rounds = sys.argv[1], float(sys.argv[2]), int(sys.argv[3])
read = lambda name: numpy.fromfile(os.path.join(folder, name + ".f64"))
source, target, guess = read("source").reshape(-1, 3), read("target").reshape(-1, 3), read("guess").reshape(4, 4)
times_ms = []
for _ in range(rounds):
    begin = time.process_time()
    target_points, target_tree = small_gicp.preprocess_points(target, voxel_m, num_threads=1)
    source_points, _ = small_gicp.preprocess_points(source, voxel_m, num_threads=1)
    result = small_gicp.align(target_points, source_points, target_tree, guess, num_threads=1)
    times_ms.append(1e3 * (time.process_time() - begin))
print(json.dumps({"times_ms": times_ms, "T": result.T_target_source.ravel().tolist(), "iterations": int(result.iterations)}))
