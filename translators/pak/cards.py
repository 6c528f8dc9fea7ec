"""The cards of a PAK deck, one place for reader and writer: columns and PAK's names of the fields.

wide: whether numbers of nodes and elements take 10 columns (IND56 = 1). F10.2 and the like imply decimals where a
number has no point.
"""

from __future__ import annotations

from functools import cache

from zrno.translators.text import Layout

TITLE = Layout("a80", "NASLOV")
FORMATS = Layout("6i5", "INDFOR IND56 IDJERDAP IOPIT ISPRESEK IRPRIT")
SWITCHES = Layout("6i2,a3,3i5,a38,6i2", "ux uy uz rx ry rz gap NDIN ISOPS ICVEL gap_2 mux muy muz mrx mry mrz")
OUTPUT = Layout("11i5", "NULAZ NBLPR NBLGR ISTKO NCVPR ISTEM ISTVN ISTSI ISTDE ISTNA IDEAS")
STEP_BLOCK = Layout("5i5", "NBL first increment last what")
SOLVER = Layout("i5,a10,2i5,2e10.0,2i5", "IREST gap NMODS ICCGG TOLG ALFAG IPAR KODUZ")
IMPERFECTION = Layout("3i5,e10.3", "MODE NODE DOF SCIM")
PERIOD = Layout("2i5,e10.0", "I NKDT DTDT")
DYNAMICS = Layout("3i5", "IMASS IDAMP INDVB")
INTEGRATION = Layout("i5,5e10.0", "MDVI PIP DIP ALFAM BETAK DAMPC")
EIGENVALUES = Layout("2i5", "ISTYP NSOPV")
ITERATION = Layout("5i5,4e10.0,i5", "METOD MAXIT KONVE KONVS KONVM TOLE TOLS TOLM TOLA NBRCR")
LOADING = Layout("3i5,5e10.0", "ITEOPT KPNOD KPDIR DTUK ALFG DELS DELUM DELFM")

DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
POLAR = "pP"

INITIAL = Layout("6i5", "IPUU IPUV IPUA ISUU ISUV ISUA")
INITIAL_VALUES = Layout("2i5,6e10.2", "N KORC v1 v2 v3 v4 v5 v6")

MODEL = Layout("3i5", "MODEL materials points")
MATERIAL = Layout("2i5,e10.0,a45", "MOD MAT GUST rest")

FUNCTIONS = Layout("2i5", "NTABFT MAXTFT")
FUNCTION = Layout("2i5", "IBR IMAX")
POINT = Layout("2e10.0", "t f")

LINE_LOAD = Layout("3i5,3e10.2,i5", "ITIPE NFUN IPRAV v1 v2 THICV KORC")
LINE_NODES = Layout("3i5", "n1 n2 n3")
FACE_LOAD = Layout("2i5,4e10.2,i5", "NFUN IPRAV v1 v2 v3 v4 KORC")
TEMPERATURE = Layout("2i5,e10.0,i5", "N NC FAK KORC")
BODY = Layout("i5,3e10.0", "NVFUB gx gy gz")
END = Layout("a4", "STOP")

MATERIAL_AXES = Layout("6e10.0", "CP1X CP1Y CP1Z CP2X CP2Y CP2Z")
LAYERS = Layout("i5", "NSLOJ")
LAYER = Layout("i5,2e10.0", "MATSL DSLOJ BBET")
SOLID_GROUP = Layout("4i5,e10.0,2i5,a25,i5", "NGAUSX NGAUSY NGAUSZ MSET BETA MSLOJ IORT gap IALFA")
PLANE_GROUP = Layout("4i5,e10.3,i5,3e10.3,i5", "IETYP NGAUSX NGAUSY MSET BETA MSLOJ CPP1 CPP2 CPP3 IALFA")
SHELL_GROUP = Layout("4i5,e10.3,i5,3e10.3,i5", "NGAUSX NGAUSY NGAUSZ MSET BETA MSLOJ CPP1 CPP2 CPP3 IALFA")
BEAM_GROUP = Layout("4i5,5e10.0,i5", "NT NELM NTIP NKAR OY OZ YM ZM ALFAU INDOF")
BEAM_SECTION = Layout("7e10.3,2i1", "POVR YI ZI TK ALFA CAPAY CAPAZ ILU ICP")


def _number(wide: bool) -> str:
    return "i10" if wide else "i5"


@cache
def basics(wide: bool) -> Layout:
    """Card 3."""
    return Layout(f"{_number(wide)},9i5", "NP NGELEM NMATM NPER JPS NKRT MIXED NCRACK NCXFEM IGBM")


@cache
def node(wide: bool) -> Layout:
    """Card 10. The mark of polar coordinates is CH in a deck of free numbering, and CH_0 in one without."""
    ids = "ux uy uz rx ry rz"
    if wide:
        return Layout("i10,a1,6i2,a1,a1,3e15.0,2i5", f"N gap {ids} gap_2 CH x y z KORC LJ")
    return Layout("i5,a1,6i2,a1,a1,3e10.0,2i5", f"N CH_0 {ids} gap CH x y z KORC LJ")


RELATIONS = Layout("2i5", "MMP NEZAV")
COEFFICIENTS = Layout("i5,6e10.0", "IRB c1 c2 c3 c4 c5 c6")


@cache
def relation(wide: bool) -> Layout:
    """A relation's card: its set of coefficients, the dependent degree of freedom, and up to six others."""
    return Layout(
        ",".join(["i5", *[f"{_number(wide)},i5"] * 7]), "IRB " + " ".join(f"node_{k} dof_{k}" for k in range(7))
    )


@cache
def group(wide: bool) -> Layout:
    """Card 13."""
    names = "NETIP NE IATYP NMODM INDBTH INDDTH INDKOV ISTRESS COEF1 COEF2 COEF3"
    return Layout(f"i5,{_number(wide)},6i5,3e10.0", names)


@cache
def solid(wide: bool) -> Layout:
    """The first card of a volume."""
    return Layout(f"{_number(wide)},5i5,a10,2e10.0", "NN NMAT IPRCO ISNA IPGS KORC gap BTH DTH")


@cache
def flat(wide: bool) -> Layout:
    """The first card of a plane element or of a shell."""
    return Layout(f"{_number(wide)},4i5,e10.0,i5,2e10.0,3e5.3", "NN NMAT IPRCO ISNA IPGS THI KORC BTH DTH t2 t3 t4")


@cache
def truss(wide: bool) -> Layout:
    """The first card of a truss."""
    return Layout(f"{_number(wide)},2i5,e10.3,i5,2e10.0", "NN NMAT ISNA APR KORC BTH DTH")


@cache
def beam(wide: bool) -> Layout:
    """The only card of a beam; CTR is a point that the local y axis looks to."""
    numbers = "3i10" if wide else "3i5"
    return Layout(f"{numbers},i5,a5,i5,a5,5e10.2", "NN n1 n2 NMAT gap NAP gap_2 CTR1 CTR2 CTR3 BTH DTH")


@cache
def nodes(wide: bool, first: int, last: int) -> Layout:
    """A card of node numbers: an element's nodes first..last."""
    return Layout(f"{last - first + 1}{_number(wide)}", " ".join(f"n{k}" for k in range(first, last + 1)))


@cache
def loads(wide: bool) -> Layout:
    """Card 15: how many cards of each load."""
    names = "NCF NPP2 NPP3 NPGR gap NPLJ NTEMP NZADP INDZS ICERNE"
    return Layout("4i10,a10,5i10" if wide else "4i5,a5,5i5", names)


@cache
def force(wide: bool) -> Layout:
    """Card 15-1."""
    return Layout(f"{_number(wide)},2i5,e10.0,i5,e10.0", "N IP NC FAK KORC FPOM")


@cache
def displacement(wide: bool) -> Layout:
    """Card 15-8."""
    return Layout(f"{_number(wide)},2i5,e10.2,i5", "N IP NC FAK KORC")
