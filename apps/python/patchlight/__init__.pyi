"""Adaptive-meshing radiosity, one function a step.

Lengths are metres relative to Scene.center, light is W/m2 in three bands of linear Rec. 709. Arrays that come from an
object are read-only views of what it holds: copy() one to change it. Long calls let other threads run and can be
interrupted with Ctrl-C.
"""

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

__version__: str

_Floats = npt.NDArray[np.float64]
_Indices = npt.NDArray[np.uint32]
_Vector = tuple[float, float, float]
_VectorLike = Sequence[float] | _Floats
_Path = str | os.PathLike[str]

class SceneError(ValueError):
    code: str

class RunError(ValueError):
    code: str

class SceneOptions:
    unit: float
    max_reflectance: float
    snap: float
    all_two_sided: bool
    two_sided: list[str]
    emitters: dict[str, _Vector]
    require_emitter: bool
    join_objects: bool
    def __init__(
        self,
        *,
        unit: float = ...,
        max_reflectance: float = ...,
        snap: float = ...,
        all_two_sided: bool = ...,
        two_sided: Sequence[str] = ...,
        emitters: dict[str, _Vector] = ...,
        require_emitter: bool = ...,
        join_objects: bool = ...,
    ) -> None: ...

class MeshingOptions:
    max_edge: float
    min_angle: float
    max_elements: int
    def __init__(self, *, max_edge: float = ..., min_angle: float = ..., max_elements: int = ...) -> None: ...

_Method = Literal["hemicube", "hemisphere", "quadrature", "exact"]
_Directions = Literal["stratified", "regular-grid", "lecture-grid"]
_Solver = Literal["progressive", "jacobi", "gauss-seidel", "conjugate-gradient", "bicgstab", "hierarchical"]
_Order = Literal["unshot-power", "unshot-radiosity"]
_Indicator = Literal["residual", "vertex-difference"]
_Marking = Literal["doerfler", "fixed-fraction"]
_Refine = Literal["none", "intensity", "discontinuity", "both"]
_Elements = Literal["linear", "quadratic"]
_Direct = Literal["exact", "sampled"]

class FormFactorOptions:
    method: _Method
    directions: _Directions
    rays: int
    shadow_rays: int
    small_source: float
    resolution: int
    tolerance: float
    seed: int
    def __init__(
        self,
        *,
        method: _Method = ...,
        directions: _Directions = ...,
        rays: int = ...,
        shadow_rays: int = ...,
        small_source: float = ...,
        resolution: int = ...,
        tolerance: float = ...,
        seed: int = ...,
    ) -> None: ...

class SolveOptions:
    solver: _Solver
    tolerance: float
    max_sweeps: int
    order: _Order
    ambient: bool
    overshoot: bool
    def __init__(
        self,
        *,
        solver: _Solver = ...,
        tolerance: float = ...,
        max_sweeps: int = ...,
        order: _Order = ...,
        ambient: bool = ...,
        overshoot: bool = ...,
    ) -> None: ...

class GatherOptions:
    rays: int
    shadow_rays: int
    small_source: float
    crease_angle: float
    seed: int
    def __init__(
        self,
        *,
        rays: int = ...,
        shadow_rays: int = ...,
        small_source: float = ...,
        crease_angle: float = ...,
        seed: int = ...,
    ) -> None: ...

class EstimateOptions:
    indicator: _Indicator
    rays: int
    def __init__(self, *, indicator: _Indicator = ..., rays: int = ...) -> None: ...

class MarkOptions:
    marking: _Marking
    share: float
    least: float
    smallest: float
    local: float
    def __init__(
        self,
        *,
        marking: _Marking = ...,
        share: float = ...,
        least: float = ...,
        smallest: float = ...,
        local: float = ...,
    ) -> None: ...

class LineOptions:
    least_saving: float
    secondary_share: float
    most_secondary: int
    def __init__(
        self, *, least_saving: float = ..., secondary_share: float = ..., most_secondary: int = ...
    ) -> None: ...

class SurfacePoint:
    position: _Vector
    limit: _Vector
    surface: int
    def __init__(self, *, position: _VectorLike = ..., limit: _VectorLike = ..., surface: int = ...) -> None: ...

class AdaptiveOptions:
    meshing: MeshingOptions
    form_factors: FormFactorOptions
    final: SolveOptions
    gather: GatherOptions
    estimate: EstimateOptions
    mark: MarkOptions
    lines: LineOptions
    refine: _Refine
    elements: _Elements
    direct: _Direct
    iterations: int
    target_error: float
    max_elements: int
    mesh: MeshArrays | None
    looked_at: list[SurfacePoint]
    def __init__(
        self,
        *,
        meshing: MeshingOptions = ...,
        form_factors: FormFactorOptions = ...,
        final: SolveOptions = ...,
        gather: GatherOptions = ...,
        estimate: EstimateOptions = ...,
        mark: MarkOptions = ...,
        lines: LineOptions = ...,
        refine: _Refine = ...,
        elements: _Elements = ...,
        direct: _Direct = ...,
        iterations: int = ...,
        target_error: float = ...,
        max_elements: int = ...,
        mesh: MeshArrays | None = ...,
        looked_at: Sequence[SurfacePoint] = ...,
    ) -> None: ...

class Material:
    @property
    def name(self) -> str: ...
    @property
    def reflectance(self) -> _Vector: ...
    @property
    def emission(self) -> _Vector: ...
    @property
    def two_sided(self) -> bool: ...

class Surface:
    @property
    def material(self) -> int: ...
    @property
    def normal(self) -> _Vector: ...
    @property
    def area(self) -> float: ...

class Scene:
    @property
    def name(self) -> str: ...
    @property
    def center(self) -> _Vector: ...
    @property
    def diameter(self) -> float: ...
    @property
    def unit(self) -> float: ...
    @property
    def closed(self) -> bool: ...
    @property
    def surfaces(self) -> list[Surface]: ...
    @property
    def materials(self) -> list[Material]: ...
    @property
    def vertices(self) -> _Floats: ...

class RayCaster:
    def __init__(self, scene: Scene) -> None: ...
    @property
    def instruction_set(self) -> str: ...

class MeshArrays:
    @property
    def positions(self) -> _Floats: ...
    @property
    def triangles(self) -> _Indices: ...
    @property
    def patch_surface(self) -> _Indices: ...
    @property
    def vertex_surface(self) -> _Indices: ...

class PatchMesh:
    def __len__(self) -> int: ...
    @property
    def patch_count(self) -> int: ...
    @property
    def vertex_count(self) -> int: ...
    @property
    def positions(self) -> _Floats: ...
    @property
    def triangles(self) -> _Indices: ...
    @property
    def patch_surface(self) -> _Indices: ...
    @property
    def vertex_surface(self) -> _Indices: ...
    @property
    def areas(self) -> _Floats: ...
    @property
    def neighbours(self) -> npt.NDArray[np.int64]: ...
    @property
    def line_count(self) -> int: ...
    @property
    def arrays(self) -> MeshArrays: ...

class SurfaceLine:
    @property
    def surface(self) -> int: ...
    @property
    def kind(self) -> Literal["contact", "EV", "VE", "EEE", "plane"]: ...
    @property
    def start(self) -> tuple[float, float]: ...
    @property
    def end(self) -> tuple[float, float]: ...

class Emitted:
    @property
    def exact(self) -> bool: ...
    @property
    def lines(self) -> list[SurfaceLine]: ...

class Exchange:
    def __init__(self, scene: Scene, caster: RayCaster, mesh: PatchMesh, emitted: Emitted) -> None: ...

class FormFactors:
    @property
    def row_start(self) -> npt.NDArray[np.uint64]: ...
    @property
    def columns(self) -> _Indices: ...
    @property
    def factors(self) -> _Floats: ...

class RadiositySystem:
    @property
    def area(self) -> _Floats: ...
    @property
    def rho(self) -> _Floats: ...
    @property
    def direct(self) -> _Floats: ...
    @property
    def F(self) -> FormFactors: ...

class SolveReport:
    @property
    def solver(self) -> _Solver: ...
    @property
    def iterations(self) -> int: ...
    @property
    def residual(self) -> float: ...
    @property
    def unshot(self) -> float: ...
    @property
    def converged(self) -> bool: ...
    @property
    def links(self) -> int: ...
    @property
    def history(self) -> list[float]: ...

class EnergyBalance:
    @property
    def emitted(self) -> float: ...
    @property
    def absorbed(self) -> float: ...
    @property
    def escaped(self) -> float: ...
    @property
    def relative_residual(self) -> float: ...

class PatchSolution:
    @property
    def B(self) -> _Floats: ...
    @property
    def report(self) -> SolveReport: ...
    @property
    def energy(self) -> EnergyBalance: ...
    @property
    def rays(self) -> int: ...

class Lighting:
    def __init__(
        self,
        exchange: Exchange,
        emitted: Emitted,
        system: RadiositySystem,
        patches: PatchSolution,
        options: AdaptiveOptions,
    ) -> None: ...
    @property
    def rays(self) -> int: ...
    def irradiance(self, exchange: Exchange, points: Sequence[SurfacePoint], rays: int = 512) -> _Floats: ...

class ErrorEstimate:
    def __init__(
        self,
        scene: Scene,
        mesh: PatchMesh,
        vertex_B: _Floats,
        eta: _Floats,
        edge: npt.NDArray[np.integer[Any]] | None = None,
    ) -> None: ...
    @property
    def eta(self) -> _Floats: ...
    @property
    def edge(self) -> npt.NDArray[np.uint8]: ...
    @property
    def total(self) -> float: ...
    @property
    def relative(self) -> float: ...

class Evaluation:
    @property
    def error(self) -> ErrorEstimate: ...
    @property
    def vertex_B(self) -> _Floats: ...
    @property
    def rays(self) -> int: ...

class Reconstruction:
    @property
    def vertex_B(self) -> _Floats: ...
    @property
    def middle_B(self) -> _Floats: ...
    @property
    def rays(self) -> int: ...

class RefinementPlan:
    lines: list[SurfaceLine]
    def __init__(
        self,
        patches: npt.NDArray[np.integer[Any]] | Sequence[int],
        edges: npt.NDArray[np.integer[Any]] | Sequence[int] | None = None,
        lines: Sequence[SurfaceLine] = ...,
    ) -> None: ...
    @property
    def patches(self) -> _Indices: ...
    @property
    def edges(self) -> npt.NDArray[np.uint8]: ...
    def __bool__(self) -> bool: ...

class AdaptiveStep:
    @property
    def cycle(self) -> int: ...
    @property
    def stage(self) -> Literal["uniform", "rough", "adaptive", "final"]: ...
    @property
    def mesh(self) -> PatchMesh: ...
    @property
    def B(self) -> _Floats: ...
    @property
    def vertex_B(self) -> _Floats: ...
    @property
    def middle_B(self) -> _Floats: ...
    @property
    def error(self) -> ErrorEstimate: ...
    @property
    def energy(self) -> EnergyBalance: ...
    @property
    def report(self) -> SolveReport: ...
    @property
    def splits(self) -> int: ...
    @property
    def rays(self) -> int: ...

class AdaptiveSolution:
    @property
    def mesh(self) -> PatchMesh: ...
    @property
    def B(self) -> _Floats: ...
    @property
    def vertex_B(self) -> _Floats: ...
    @property
    def middle_B(self) -> _Floats: ...
    @property
    def error(self) -> ErrorEstimate: ...
    @property
    def energy(self) -> EnergyBalance: ...
    @property
    def report(self) -> SolveReport: ...
    @property
    def converged(self) -> bool: ...

class StoredSolution:
    @property
    def scene(self) -> Scene: ...
    @property
    def mesh(self) -> PatchMesh: ...
    @property
    def B(self) -> _Floats: ...
    @property
    def vertex_B(self) -> _Floats: ...
    @property
    def middle_B(self) -> _Floats: ...
    @property
    def eta(self) -> _Floats: ...
    @property
    def edge(self) -> npt.NDArray[np.uint8]: ...

class Run:
    @property
    def folder(self) -> Path: ...
    @property
    def record(self) -> dict[str, Any]: ...
    @property
    def cycles(self) -> list[int]: ...
    def solution(self, cycle: int | None = None) -> StoredSolution: ...

def read_scene(file: _Path, options: SceneOptions = ...) -> Scene: ...
def triangulate(scene: Scene, options: MeshingOptions = ..., lines: Sequence[SurfaceLine] = ...) -> PatchMesh: ...
def first_mesh(scene: Scene, options: AdaptiveOptions) -> PatchMesh: ...
def emittance(scene: Scene, mesh: PatchMesh) -> _Floats: ...
def emitted_light(scene: Scene, options: AdaptiveOptions) -> Emitted: ...
def assemble(exchange: Exchange, options: AdaptiveOptions) -> RadiositySystem: ...
def solve(exchange: Exchange, system: RadiositySystem, options: AdaptiveOptions) -> PatchSolution: ...
def estimate(exchange: Exchange, lighting: Lighting, options: AdaptiveOptions) -> Evaluation: ...
def mark(
    scene: Scene, mesh: PatchMesh, B: _Floats, error: ErrorEstimate, options: MarkOptions = ...
) -> RefinementPlan: ...
def worthwhile_lines(
    exchange: Exchange, error: ErrorEstimate, emitted: Emitted, options: AdaptiveOptions
) -> list[SurfaceLine]: ...
def plan_next(
    exchange: Exchange,
    B: _Floats,
    error: ErrorEstimate,
    lighting: Lighting,
    emitted: Emitted,
    options: AdaptiveOptions,
) -> RefinementPlan: ...
def finished(
    mesh: PatchMesh, error: ErrorEstimate, plan: RefinementPlan, cycle: int, options: AdaptiveOptions
) -> bool: ...
def refine(scene: Scene, mesh: PatchMesh, plan: RefinementPlan, options: AdaptiveOptions) -> PatchMesh: ...
def final_nodes(
    exchange: Exchange, lighting: Lighting, vertex_B: _Floats, options: AdaptiveOptions
) -> Reconstruction: ...
def patch_means(mesh: PatchMesh, vertex_B: _Floats) -> _Floats: ...
def solve_adaptively(
    scene: Scene, options: AdaptiveOptions = ..., on_step: Callable[[AdaptiveStep], object] | None = None
) -> AdaptiveSolution: ...
def encode_solution(
    scene: Scene,
    mesh: PatchMesh,
    B: _Floats,
    vertex_B: _Floats,
    error: ErrorEstimate,
    middle_B: _Floats | None = None,
) -> bytes: ...
def read_solution(file: _Path) -> StoredSolution: ...
def open_run(folder: _Path) -> Run: ...
