"""Seeds over two processes of one thread each."""

import multiprocessing
import os
from concurrent.futures import ProcessPoolExecutor


def in_parallel(task, seeds):
    """Results of a task for each seed, in order."""
    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    before = {name: os.environ.get(name) for name in names}
    os.environ.update(dict.fromkeys(names, "1"))
    try:
        with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
            return list(pool.map(task, seeds, chunksize=10))
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
