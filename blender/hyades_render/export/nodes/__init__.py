"""Shader nodes as materials and textures of the job.

`translator.Translator` walks a material's nodes. Shaders become materials (closures.py), values become textures where the job
has one that means the same (native.py); every other graph of values is computed (evaluate/) and baked to a picture (bake.py).
"""
