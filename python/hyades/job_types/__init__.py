"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""
