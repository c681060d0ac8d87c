"""This project beside what others would use for the same rods: python -m benchmarks.peers.

problems, statics: the motions and the static state that are timed, and what an error is. ours, lines,
compiled_lines, by_hand (with by_hand.c), elastica, multibody: the solvers, and all that was chosen for each.
search: the cheapest setting. motion, standing: the tables. writing: their form. others: packages that were looked
at and do another job.
"""
