"""Words in the headings of lathe profiles, by kind of column, in the languages of cue makers."""

from __future__ import annotations

from enum import StrEnum


class Column(StrEnum):
    """Kinds of columns: of lengths, and of material names."""

    POSITION = "x"
    DIAMETER = "diameter"
    RADIUS = "radius"
    BORE = "bore"
    MATERIAL = "material"
    CORE = "core"
    FERRULE = "ferrule"


# In order of precedence: "bore diameter" is a bore, "diameter at x" a diameter.
_TABLE = {
    Column.CORE: "core kern noyau âme núcleo nucleo anima сердечник 芯 심재 코어",
    Column.MATERIAL: """material materials wood holz werkstoff matériau materiau matière madera legno materiale madeira
        materiaal материал дерево древесина 材料 材质 材質 素材 木材 재질 재료 소재 목재""",
    Column.BORE: """bore bored inner inside id hole hollow bohrung innendurchmesser perçage alésage alesage agujero
        taladro foro furo отверстие отверстия 内径 內徑 孔 穴 中空 내경 구멍 보어""",
    Column.RADIUS: """radius radii rad r halbmesser rayon radio raggio raio straal радиус 半径 半徑 반지름 반경""",
    Column.DIAMETER: """diameter diameters dia diam d ø od width thickness thick dicke durchmesser diamètre diametre
        diámetro diametro diâmetro średnica диаметр толщина 直径 直徑 外径 外徑 太さ 직경 지름 외경""",
    Column.POSITION: """x z position pos place location station distance dist length along from von abstand länge
        laenge distancia posición posicion posizione distanza distância posição longueur longitud lunghezza
        comprimento afstand lengte avstånd расстояние положение позиция длина координата
        位置 距離 距离 座標 坐标 長さ 长度 長度 위치 거리 길이 좌표""",
    Column.FERRULE: """ferrule zwinge hülse huelse virola virole ghiera ферула феррула 先角 フェルール 铜箍 페룰
        선골""",
}
WORDS = {kind: frozenset(words.split()) for kind, words in _TABLE.items()}
# Ends from which a position is measured.
_ENDS = {
    "butt": """griff stoß stoss gelenk talon culata mango junta calcio giunto турняк турняка комель комля стык стыка
        バット ジョイント 手元 尾 后把 後把 接牙 根部 버트 조인트 하대""",
    "tip": """tip spitze leder pointe procédé punta ponta suela кончик кончика наклейка наклейки
        先端 タップ ティップ 皮头 皮頭 尖 前端 팁 선단""",
}
BUTT, TIP = (frozenset(words.split()) for words in _ENDS.values())
_FIRST_WITHOUT_BLANKS = "\u3000"  # Chinese, Japanese and Korean letters follow; their headings are single words


def has_word(text: str, words: frozenset[str]) -> bool:
    """Whether a word of a heading is one of some words or, in a script without blanks, contains one."""
    return text in words or any(word in text for word in words if word >= _FIRST_WITHOUT_BLANKS)
