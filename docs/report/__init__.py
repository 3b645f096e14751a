"""The report that docs/benchmarks.py writes."""
