// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqVoxplexLabelModel.h"

#include "vtkSMLabelColorsProxy.h"

#include <QColor>
#include <QGuiApplication>
#include <QLocale>
#include <QPalette>

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

QColor colorOf(vtkTypeInt64 value, const vtkPVLabelInformation::LabelEntry& label)
{
  const std::array<double, 3> color = vtkSMLabelColorsProxy::ColorOf(value, label);
  return QColor::fromRgbF(color[0], color[1], color[2]);
}

/** Empty for no bound. */
QString sizeText(double size)
{
  return size == 0.0 ? QString() : QString::number(size, 'g', 15);
}

} // namespace

pqVoxplexLabelModel::pqVoxplexLabelModel(QObject* parent)
  : QAbstractTableModel(parent)
{
}

//----------------------------------------------------------------------------------------------------
void pqVoxplexLabelModel::setLabels(const vtkPVLabelInformation::LabelMap& labels)
{
  if (labels != this->Labels)
  {
    this->Labels = labels;
    this->setSettings(this->settings());
  }
}

void pqVoxplexLabelModel::setSettings(const QList<QVariant>& values)
{
  std::map<vtkTypeInt64, Row> rows;
  for (const auto& [value, label] : this->Labels)
  {
    rows.emplace(value, Row{ value, label, true, Setting() });
  }
  for (int i = 0; i + 2 < values.size(); i += 3)
  {
    const auto value = static_cast<vtkTypeInt64>(values[i].toDouble());
    Row& row = rows.emplace(value, Row{ value, {}, false, Setting() }).first->second;
    row.Chosen = { values[i + 1].toDouble(), values[i + 2].toDouble() != 0.0 };
  }
  this->beginResetModel();
  this->Rows.clear();
  for (const auto& [value, row] : rows)
  {
    this->Rows.push_back(row);
  }
  this->endResetModel();
}

QList<QVariant> pqVoxplexLabelModel::settings() const
{
  QList<QVariant> values;
  for (const Row& row : this->Rows)
  {
    if (row.Chosen.Size != 0.0 || !row.Chosen.IsMeshed)
    {
      values << static_cast<double>(row.Value) << row.Chosen.Size
             << (row.Chosen.IsMeshed ? 1.0 : 0.0);
    }
  }
  return values;
}

int pqVoxplexLabelModel::numberMeshed() const
{
  return static_cast<int>(std::count_if(this->Rows.begin(), this->Rows.end(),
    [](const Row& row) { return row.Occurs && row.Chosen.IsMeshed; }));
}

bool pqVoxplexLabelModel::setRows(const QList<int>& rows, int column, const QVariant& value)
{
  bool isNumber = true;
  const QString text = value.toString().trimmed().replace(',', '.');
  const double size = column == Size && !text.isEmpty() ? text.toDouble(&isNumber) : 0.0;
  if (rows.isEmpty() || (column != Tick && column != Size) || !isNumber || !std::isfinite(size) ||
    size < 0.0)
  {
    return false;
  }
  for (const int row : rows)
  {
    Setting& chosen = this->Rows[static_cast<std::size_t>(row)].Chosen;
    if (column == Tick)
    {
      chosen.IsMeshed = value.toInt() == Qt::Checked;
    }
    else
    {
      chosen.Size = size;
    }
  }
  const auto [first, last] = std::minmax_element(rows.begin(), rows.end());
  Q_EMIT this->dataChanged(this->index(*first, 0), this->index(*last, NumberOfColumns - 1));
  Q_EMIT this->settingsChanged();
  return true;
}

//----------------------------------------------------------------------------------------------------
int pqVoxplexLabelModel::rowCount(const QModelIndex& parent) const
{
  return parent.isValid() ? 0 : static_cast<int>(this->Rows.size());
}

int pqVoxplexLabelModel::columnCount(const QModelIndex& parent) const
{
  return parent.isValid() ? 0 : NumberOfColumns;
}

QVariant pqVoxplexLabelModel::data(const QModelIndex& index, int role) const
{
  const Row& row = this->Rows[static_cast<std::size_t>(index.row())];
  const int column = index.column();
  switch (role)
  {
    case Qt::DisplayRole:
    case Qt::EditRole:
      return this->text(row, column);
    case SortRole:
      return this->sortKey(row, column);
    case SearchRole:
      return QString("%1 %2").arg(row.Value).arg(QString::fromStdString(row.Label.Name));
    case Qt::CheckStateRole:
      return column == Tick
        ? QVariant(static_cast<int>(row.Chosen.IsMeshed ? Qt::Checked : Qt::Unchecked))
        : QVariant();
    case Qt::DecorationRole:
      return column == Colour ? QVariant(colorOf(row.Value, row.Label)) : QVariant();
    case Qt::TextAlignmentRole:
      return column == Name ? QVariant()
                            : QVariant(static_cast<int>(Qt::AlignRight | Qt::AlignVCenter));
    case Qt::ToolTipRole:
      return column == Name ? this->text(row, column)
                            : this->headerData(column, Qt::Horizontal, role);
    case Qt::ForegroundRole:
      return row.Occurs
        ? QVariant()
        : QVariant(QGuiApplication::palette().brush(QPalette::Disabled, QPalette::Text));
    default:
      return QVariant();
  }
}

QVariant pqVoxplexLabelModel::text(const Row& row, int column) const
{
  switch (column)
  {
    case Number:
      return QString::number(row.Value);
    case Name:
      return row.Occurs ? QString::fromStdString(row.Label.Name) : tr("not in the image");
    case Voxels:
      return QLocale().toString(static_cast<qlonglong>(row.Label.Voxels));
    case Size:
      return sizeText(row.Chosen.Size);
    default:
      return QVariant();
  }
}

QVariant pqVoxplexLabelModel::sortKey(const Row& row, int column) const
{
  switch (column)
  {
    case Tick:
      return row.Chosen.IsMeshed ? 0 : 1;
    case Name:
      return QString::fromStdString(row.Label.Name);
    case Colour:
      return colorOf(row.Value, row.Label).hsvHue();
    case Voxels:
      return static_cast<qlonglong>(row.Label.Voxels);
    case Size:
      return row.Chosen.Size;
    default:
      return static_cast<qlonglong>(row.Value);
  }
}

QVariant pqVoxplexLabelModel::headerData(int section, Qt::Orientation orientation, int role) const
{
  if (orientation != Qt::Horizontal || section < 0 || section >= NumberOfColumns)
  {
    return QVariant();
  }
  static const std::array<const char*, NumberOfColumns> texts = { QT_TR_NOOP("Mesh"),
    QT_TR_NOOP("Label"), QT_TR_NOOP("Name"), "", QT_TR_NOOP("Voxels"), QT_TR_NOOP("Size") };
  static const std::array<const char*, NumberOfColumns> tips = {
    QT_TR_NOOP("Whether the label is meshed. Otherwise it becomes background."),
    QT_TR_NOOP("The value of the label in the image"), QT_TR_NOOP("The name of the label"),
    QT_TR_NOOP("The colour of the label, in the mesh, too"),
    QT_TR_NOOP("The number of voxels of the label, at the present time"),
    QT_TR_NOOP("The largest circumradius of the label's elements, in the unit of the image's "
               "spacing. Empty: no bound. A double click changes it.")
  };
  const auto s = static_cast<std::size_t>(section);
  return role == Qt::DisplayRole ? QVariant(tr(texts[s]))
    : role == Qt::ToolTipRole    ? QVariant(tr(tips[s]))
                                 : QVariant();
}

Qt::ItemFlags pqVoxplexLabelModel::flags(const QModelIndex& index) const
{
  Qt::ItemFlags flags = Qt::ItemIsEnabled | Qt::ItemIsSelectable;
  flags.setFlag(Qt::ItemIsUserCheckable, index.column() == Tick);
  flags.setFlag(Qt::ItemIsEditable, index.column() == Size);
  return flags;
}
