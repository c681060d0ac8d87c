"""What the paper is called, and what writes the list of its errata."""

TITLE = "Geometric Field Theory for Elastohydrodynamics of Cosserat Rods"
AUTHORS = "M. Yan, M. Warda, B. Németh, L. Kikuchi, R. Adhikari"
COMMAND = "python -m paper_checks"
