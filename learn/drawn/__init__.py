"""Modules of the drawing program: banks, shapes, garments, cloth, grounds, scene."""
